# Adds the build's provenance (commit, compiler, flags, library versions) to fw_system.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
set(provenance_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}")
get_target_property(provenance_options federwerk_options INTERFACE_COMPILE_OPTIONS)
foreach(option IN LISTS provenance_options)
  if(NOT option MATCHES "^\\$" AND NOT option MATCHES "^-W" AND NOT option STREQUAL "")
    string(APPEND provenance_flags " ${option}")
  endif()
endforeach()
if(FEDERWERK_NATIVE)
  string(APPEND provenance_flags " -march=native")
endif()
string(STRIP "${provenance_flags}" provenance_flags)

# SuiteSparse tells its versions in headers only.
set(cholmod_version "")
foreach(part MAIN SUB SUBSUB)
  file(STRINGS ${SUITESPARSE_INCLUDE_DIR}/cholmod_core.h line REGEX "define CHOLMOD_${part}_VERSION [0-9]+")
  string(REGEX MATCH "[0-9]+$" number "${line}")
  list(APPEND cholmod_version ${number})
endforeach()
list(JOIN cholmod_version "." cholmod_version)

string(JOIN " " provenance_libraries
  "Boost=${Boost_VERSION_STRING}" "CHOLMOD=${cholmod_version}" "CLI11=${CLI11_VERSION}" "Eigen=${Eigen3_VERSION}" "fmt=${fmt_VERSION}"
  "GSL=${GSL_VERSION}" "HDF5=${HDF5_VERSION}" "OpenSSL=${OPENSSL_VERSION}" "PETSc=${PETSC_VERSION}"
  "SLEPc=${SLEPC_VERSION}" "SUNDIALS=${SUNDIALS_VERSION}" "toml++=${TOMLPP_VERSION}")

set(provenance_dir ${CMAKE_CURRENT_BINARY_DIR}/generated)
add_custom_target(provenance
  BYPRODUCTS ${provenance_dir}/provenance_build.hpp
  COMMAND ${CMAKE_COMMAND} "-DSOURCE_DIR=${PROJECT_SOURCE_DIR}"
          "-DTEMPLATE=${CMAKE_CURRENT_SOURCE_DIR}/system/provenance_build.hpp.in"
          "-DOUTPUT=${provenance_dir}/provenance_build.hpp"
          "-DVERSION=${PROJECT_VERSION}"
          "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
          "-DCOMPILER_FLAGS=${provenance_flags}"
          "-DLIBRARIES=${provenance_libraries}"
          -P ${CMAKE_CURRENT_SOURCE_DIR}/system/write_provenance.cmake
  VERBATIM)
add_dependencies(fw_system provenance)
target_include_directories(fw_system PRIVATE ${provenance_dir})
