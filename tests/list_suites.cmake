# Writes FILE, which registers every suite of the test PROGRAM with ctest under LABEL, with COST to say when it should
# start. Runs after the program is linked: cmake -DPROGRAM=… -DFILE=… -DLABEL=… -DCOST=… -P list_suites.cmake
# With -DENVIRONMENT=NAME=VALUE it runs with that variable, with -DFAILURE=|REGEX it fails where its output matches.
#
# A process per suite, not per test: most tests take milliseconds, while the libraries behind them take longer to load,
# and the tests of a suite share reference solutions. A large suite is dealt out to two processes: more of them would
# compute the same references more often.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE code TIMEOUT 120)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: exit code ${code}\n${listed}")
endif()
string(REPLACE "[" "(" listed "${listed}")  # brackets and semicolons mean something in CMake's lists
string(REPLACE "]" ")" listed "${listed}")
string(REPLACE ";" "," listed "${listed}")
string(REPLACE "\n" ";" lines "${listed}")

set(suites "")
set(all 0)
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)\\.")
    set(suite ${CMAKE_MATCH_1})
    list(APPEND suites ${suite})
    set(tests_${suite} 0)
  elseif(line MATCHES "^  [A-Za-z0-9_/]+")
    math(EXPR tests_${suite} "${tests_${suite}} + 1")
    math(EXPR all "${all} + 1")
  endif()
endforeach()
if(all EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} has no test")
endif()

set(text "# ${all} tests\n")
foreach(suite IN LISTS suites)
  math(EXPR parts "(${tests_${suite}} + 24) / 25")
  if(parts GREATER 2)
    set(parts 2)
  endif()
  foreach(part RANGE 1 ${parts})
    set(name "${LABEL}.${suite}")
    set(environment "${ENVIRONMENT}")
    if(parts GREATER 1)
      math(EXPR index "${part} - 1")
      string(APPEND name " (${part} of ${parts})")
      list(APPEND environment GTEST_TOTAL_SHARDS=${parts} GTEST_SHARD_INDEX=${index})
    endif()
    string(APPEND text "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
      "set_tests_properties([=[${name}]=] PROPERTIES LABELS ${LABEL} COST ${COST} TIMEOUT 1200"
      " FAIL_REGULAR_EXPRESSION [=[Running 0 tests${FAILURE}]=] ENVIRONMENT [=[${environment}]=])\n")
  endforeach()
endforeach()
file(WRITE ${FILE} "${text}")
