#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/process.hpp"
#include "catalog/methods.hpp"
#include "catalog/problems.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {
namespace {

using store::test::run_python;
using store::test::ScratchDirectory;
using ::testing::HasSubstr;

/// Runs `federwerk` and a Python program that finds its output, parsed as JSON, in `x`; what it prints.
std::string with_json(const std::vector<std::string>& arguments, const std::string& program) {
  const ScratchDirectory scratch;
  const ProcessResult result = run(scratch.path(), arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  store::test::write_bytes(scratch / "out.json", result.out);
  return run_python("import json, sys\nx = json.load(open(sys.argv[1], encoding='utf-8'))\n" + program,
                    {(scratch / "out.json").string()});
}

TEST(List, MethodsAsJsonHaveTheAgreedFields) {
  const std::string names = with_json({"list", "methods", "--json"}, R"(
types = dict(name=str, title=str, family=str, order=int, stages=int, explicit=bool, adaptive=bool,
             symplectic=bool, a_stable=bool, l_stable=bool, reference=str)
assert isinstance(x, list)
for m in x:
    for key, type_ in types.items():
        assert type(m[key]) is type_, (m, key)
        assert type_ is not str or m[key], (m, key)
    assert m['a_stable'] or not m['l_stable'], m
    # an exponential scheme needs no solve and is A-stable all the same
    assert not (m['explicit'] and m['a_stable']) or m['family'] == 'exponential', m
assert len({m['name'] for m in x}) == len(x)
by = {m['name']: m for m in x}
assert by['rk4']['order'] == 4 and by['rk4']['stages'] == 4 and by['rk4']['explicit']
assert by['implicit_euler']['l_stable'] and not by['implicit_euler']['explicit']
assert by['velocity_verlet']['symplectic'] and not by['rk4']['symplectic']
assert by['sundials:cvode_bdf']['adaptive'] and not by['rk4']['adaptive']
print(' '.join(by))
)");
  for (const catalog::MethodEntry& entry : catalog::methods()) EXPECT_THAT(names, HasSubstr(entry.name));
}

TEST(List, OraclesAreTheForeignMethods) {
  with_json({"list", "oracles", "--json"}, "assert x and all(':' in m['name'] for m in x)\n");
}

TEST(List, EverythingElseHasNameTitleAndDescription) {
  for (const std::string what : {"problems", "scenes", "studies"}) {
    with_json({"list", what, "--json"},
              "assert x and all(m['name'] and m['title'] and m['description'] for m in x)\n");
  }
}

TEST(List, TablesNameWhatTheJsonNames) {
  const ScratchDirectory scratch;
  for (const std::string what : {"methods", "problems", "scenes", "studies", "oracles"}) {
    std::vector<std::string> call = {"list", what};
    if (what == "methods") call.emplace_back("--all");
    const ProcessResult table = run(scratch.path(), call);
    EXPECT_EQ(table.exit_code, 0);
    const std::string names =
        with_json({"list", what, "--json"}, "print('\\n'.join(m['name'] for m in x))\n");
    std::istringstream lines(names);
    for (std::string name; std::getline(lines, name);) EXPECT_THAT(table.out, HasSubstr(name));
  }
}

TEST(List, FiltersAreThePropertiesThatTheJsonGives) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> filters = {
      {{"--family", "RUNGE-KUTTA"}, "'runge-kutta' in m['family'].lower()"},
      {{"--order", "4"}, "m['order'] == 4"},
      {{"--explicit"}, "m['explicit']"},
      {{"--implicit"}, "not m['explicit']"},
      {{"--adaptive"}, "m['adaptive']"},
      {{"--symplectic"}, "m['symplectic']"},
      {{"--a-stable"}, "m['a_stable']"},
      {{"--l-stable", "--family", "diagonally"}, "m['l_stable'] and 'diagonally' in m['family']"}};
  // One Python looks at all lists.
  const ScratchDirectory scratch;
  std::string properties;
  std::vector<std::string> files{(scratch / "properties").string()};
  const auto keep_list = [&](const std::vector<std::string>& filter) {
    std::vector<std::string> call = {"list", "methods", "--json"};
    call.insert(call.end(), filter.begin(), filter.end());
    const ProcessResult result = run(scratch.path(), call);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    files.push_back((scratch / std::to_string(files.size())).string());
    store::test::write_bytes(files.back(), result.out);
  };
  keep_list({});
  for (const auto& [filter, property] : filters) {
    keep_list(filter);
    properties += property + "\n";
  }
  store::test::write_bytes(files.front(), properties);
  run_python(R"(
import json, sys
whole, *found = [json.load(open(path, encoding='utf-8')) for path in sys.argv[2:]]
properties = open(sys.argv[1]).read().splitlines()
assert len(found) == len(properties) > 0
for methods, property in zip(found, properties):
    expected = [m['name'] for m in whole if eval(property)]
    assert methods and [m['name'] for m in methods] == expected, (property, methods, expected)
)",
             files);
  const ProcessResult table = run(scratch.path(), {"list", "methods", "--symplectic", "--order", "8"});
  EXPECT_THAT(table.out, HasSubstr("yoshida8"));
  EXPECT_THAT(table.out, ::testing::Not(HasSubstr("yoshida6")));
  const ProcessResult unknown = run(scratch.path(), {"list", "methods", "--family", "gauss"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("expected a part of one of"));
  EXPECT_EQ(run(scratch.path(), {"list", "problems", "--explicit"}).exit_code, 2);
}

TEST(List, MethodsStartWithTheFirstOnesAndTheFamilies) {
  const ScratchDirectory scratch;
  const std::string text = run(scratch.path(), {"list", "methods"}).out;
  for (const std::string& name : catalog::first_methods()) EXPECT_THAT(text, HasSubstr(name));
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    EXPECT_THAT(text, HasSubstr(entry.info().family.substr(0, 10)));
  }
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 60);
}

TEST(Describe, KnowsEveryListedName) {
  const ScratchDirectory scratch;
  std::string names;
  for (const std::string what : {"methods", "problems", "scenes", "studies"}) {
    names += with_json({"list", what, "--json"}, "print('\\n'.join(m['name'] for m in x))\n");
  }
  std::vector<std::string> call = {"describe"};
  std::istringstream lines(names);
  for (std::string name; std::getline(lines, name);) call.push_back(name);
  const ProcessResult text = run(scratch.path(), call);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  for (std::size_t k = 1; k < call.size(); ++k) {
    EXPECT_TRUE(text.out.starts_with(call[k] + "\n") ||
                text.out.find("\n\n" + call[k] + "\n") != std::string::npos)
        << call[k];
  }
  store::test::write_bytes(scratch / "names", names);
  call.push_back("--json");
  with_json(call, "names = open('" + (scratch / "names").string() + R"(').read().split()
assert [e['name'] for e in x] == names, (x, names)
for e in x:
    assert e['title'] and e['type'], e
)");
}

TEST(Describe, OfOneNameIsOneEntryAndOfSeveralTheirList) {
  const ScratchDirectory scratch;
  const std::string first = run(scratch.path(), {"describe", "rk4"}).out;
  const std::string second = run(scratch.path(), {"describe", "dahlquist"}).out;
  EXPECT_THAT(run(scratch.path(), {"describe", "velocity_verlet"}).out,
              HasSubstr("with dampers             1 of 2 kicks solves a sparse system for the velocity\n"));
  EXPECT_THAT(run(scratch.path(), {"describe", "symplectic_euler"}).out,
              HasSubstr("with dampers             explicit\n"));
  EXPECT_EQ(run(scratch.path(), {"describe", "rk4", "dahlquist"}).out, first + "\n" + second);
  with_json({"describe", "rk4", "--json"}, "assert x['name'] == 'rk4', x\n");
  with_json({"describe", "rk4", "dahlquist", "--json"},
            "assert [e['name'] for e in x] == ['rk4', 'dahlquist'], x\n");
  const ProcessResult unknown = run(scratch.path(), {"describe", "rk4", "rk44"});
  EXPECT_NE(unknown.exit_code, 0);
  EXPECT_EQ(unknown.out, "");
  EXPECT_THAT(unknown.err, HasSubstr("\"rk44\""));
}

TEST(Describe, PrintsTheTableauOfARungeKuttaMethod) {
  with_json({"describe", "rk4", "--json"},
            "t = x['tableau']\n"
            "assert t['b'] == [1/6, 1/3, 1/3, 1/6] and t['c'] == [0, .5, .5, 1] and t['A'][3] == [0, 0, 1, "
            "0], t\n");
}

TEST(Describe, TakesTheOptionsOfACall) {
  with_json({"describe", "rkc2[stages=5]", "--json"},
            "assert x['name'] == 'rkc2' and x['call'] == 'rkc2[stages=5]' and x['stages'] == 5, x\n"
            "assert len(x['tableau']['b']) == 5 and x['derived']['order'] == 2, x\n");
  const ScratchDirectory scratch;
  const ProcessResult refused = run(scratch.path(), {"describe", "rkc2[stages=1]"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("method \"rkc2\": option stages: found \"1\""));
}

TEST(Verify, KeepsItsResultAndPrintsTheSameWhenItIsAskedAgain) {
  const ScratchDirectory scratch;
  const std::vector<std::string> arguments = {"verify", "--method", "explicit_euler", "--json",
                                              "-o",     "v.h5",     "--jobs",         "1"};
  const ProcessResult first = run(scratch.path(), arguments), again = run(scratch.path(), arguments);
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(first.out, again.out);
  EXPECT_THAT(first.out, HasSubstr("\"property\":"));
  const ProcessResult shown = run(scratch.path(), {"show", "v.h5"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("explicit_euler"));
  EXPECT_LT(again.seconds, first.seconds) << "the method was verified a second time";
}

}  // namespace
}  // namespace fw::app::test
