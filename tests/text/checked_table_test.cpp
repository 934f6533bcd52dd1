#include "text/checked_table.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>

#include "core/error.hpp"
#include "text/toml_tree.hpp"

namespace fw {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CheckedTable parse(std::string_view text) {
  return CheckedTable::parse_text(text, "a.toml");
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CheckedTable, ReadsEveryKindOfValue) {
  const auto t = parse(R"(
number = 2.5
whole = 3
count = 7
flag = true
text = "häß\n"
law = "hooke"
v = [1, 2.5, -3e-2]
list = [1, 2.5]
ints = [1, -2]
words = ["a", "b"]
vectors = [[0, 0, 0], [1, 2, 3]]
fixed = [2, 0]
between = [[0, 1], [2, 1]]
one = 4
each = [1, 2]
)");
  EXPECT_EQ(t.number("number"), 2.5);
  EXPECT_EQ(t.number("whole"), 3.0);
  EXPECT_EQ(t.integer("count", 0, 7), 7);
  EXPECT_TRUE(t.boolean("flag"));
  EXPECT_EQ(t.string("text"), "häß\n");
  EXPECT_EQ(t.choice("law", {"strain", "hooke"}), "hooke");
  EXPECT_EQ(t.vec3("v"), (Vec3<double>{1.0, 2.5, -3e-2}));
  EXPECT_THAT(t.numbers("list"), ElementsAre(1.0, 2.5));
  EXPECT_THAT(t.integers("ints"), ElementsAre(1, -2));
  EXPECT_THAT(t.strings("words"), ElementsAre("a", "b"));
  EXPECT_THAT(t.choices("words", {"b", "a"}), ElementsAre("a", "b"));
  EXPECT_THAT(t.vectors("vectors"), ElementsAre(Vec3<double>{0, 0, 0}, Vec3<double>{1, 2, 3}));
  EXPECT_THAT(t.indices("fixed", 3, "particle"), ElementsAre(2, 0));
  EXPECT_THAT(t.index_pairs("between", 3, "particle"), ElementsAre(ElementsAre(0, 1), ElementsAre(2, 1)));
  EXPECT_THAT(t.number_or_list("one", 3, "spring"), ElementsAre(4.0));
  EXPECT_THAT(t.number_or_list("each", 2, "spring"), ElementsAre(1.0, 2.0));
}

TEST(CheckedTable, ReadsIndicesAndNamesInAnyMixture) {
  const auto t = parse("a = 1\nb = 'all'\nc = ['all', 0]\nd = []\n");
  using Entry = std::variant<int, std::string>;
  EXPECT_THAT(t.indices_or_names("a", 2, "particle", {"all"}), ElementsAre(Entry(1)));
  EXPECT_THAT(t.indices_or_names("b", 2, "particle", {"all"}), ElementsAre(Entry("all")));
  EXPECT_THAT(t.indices_or_names("c", 2, "particle", {"all"}), ElementsAre(Entry("all"), Entry(0)));
  EXPECT_TRUE(t.indices_or_names("d", 2, "particle", {"all"}).empty());
}

TEST(CheckedTable, TellsTablesListsAndStringsFromOtherValues) {
  const auto t = parse("a = { x = 1 }\nb = 2\nl = []\ns = 'q'\n[c]\n[[e]]\n");
  EXPECT_TRUE(t.is_table("a"));
  EXPECT_FALSE(t.is_table("b"));
  EXPECT_TRUE(t.is_table("c"));
  EXPECT_FALSE(t.is_table("d"));
  EXPECT_TRUE(t.is_list("l"));
  EXPECT_TRUE(t.is_list("e"));
  EXPECT_FALSE(t.is_list("c"));
  EXPECT_FALSE(t.is_list("d"));
  EXPECT_TRUE(t.is_string("s"));
  EXPECT_FALSE(t.is_string("b"));
  EXPECT_FALSE(t.is_string("d"));
}

TEST(CheckedTable, KnowsWhichKeysTheFileGives) {
  const auto t = parse("b = 1\na = 2\n");
  EXPECT_TRUE(t.has("a"));
  EXPECT_FALSE(t.has("d"));
  EXPECT_THAT(t.keys(), ElementsAre("a", "b"));
}

struct BadRead {
  std::string text;
  std::function<void(const CheckedTable&)> read;
  std::string message;
};

TEST(CheckedTable, NamesFileLineKeyIndexFoundAndExpected) {
  const auto in_s = [](auto read) { return [read](const CheckedTable& t) { read(t.table("s")); }; };
  using T = const CheckedTable&;
  const std::vector<BadRead> cases = {
      {"\nx = 'a'", [](T t) { t.number("x"); },
       "a.toml:2: x: found the string \"a\", expected a finite number"},
      {"x = nan", [](T t) { t.number("x"); }, "a.toml:1: x: found nan, expected a finite number"},
      {"x = -inf", [](T t) { t.number("x"); }, "a.toml:1: x: found -inf, expected a finite number"},
      {"x = 0", [](T t) { t.positive_number("x"); }, "a.toml:1: x: found 0, expected a finite number > 0"},
      {"x = -0.5", [](T t) { t.number("x", NumberRule::nonnegative); },
       "a.toml:1: x: found -0.5, expected a finite number >= 0"},
      {"x = true", [](T t) { t.number("x"); }, "a.toml:1: x: found true, expected a finite number"},
      {"x = 2020-01-01", [](T t) { t.number("x"); },
       "a.toml:1: x: found a date or time, expected a finite number"},
      {"", [](T t) { t.number("x"); }, "a.toml: missing key \"x\", expected a number"},
      {"[s]\n", in_s([](T s) { s.string("x"); }), "a.toml:1: [s]: missing key \"x\", expected a string"},
      {"[s]\nx = 1", in_s([](T s) { s.string("x"); }), "a.toml:2: [s] x: found 1, expected a string"},
      {"[s]\nx = 1.0", in_s([](T s) { s.integer("x"); }), "a.toml:2: [s] x: found 1.0, expected an integer"},
      {"x = 4", [](T t) { t.integer("x", 1, 3); }, "a.toml:1: x: found 4, expected an integer from 1 to 3"},
      {"x = 0", [](T t) { t.integer("x", 1); }, "a.toml:1: x: found 0, expected an integer >= 1"},
      {"x = 1", [](T t) { t.boolean("x"); }, "a.toml:1: x: found 1, expected true or false"},
      {"law = 'hoke'",
       [](T t) {
         t.choice("law", {"hooke", "strain"});
       },
       "a.toml:1: law: found the string \"hoke\", expected one of \"hooke\", \"strain\"; did you mean "
       "\"hooke\"?"},
      {"law = 'zzz'", [](T t) { t.choice("law", {"hooke"}); },
       "a.toml:1: law: found the string \"zzz\", expected \"hooke\""},
      {"v = [1, 2]", [](T t) { t.vec3("v"); },
       "a.toml:1: v: found an array of 2 entries, expected an array of 3 numbers [x, y, z]"},
      {"v = [1,\n 'b', 2]", [](T t) { t.vec3("v"); },
       "a.toml:2: v[1]: found the string \"b\", expected a finite number"},
      {"l = 1", [](T t) { t.numbers("l"); }, "a.toml:1: l: found 1, expected an array of numbers"},
      {"[s]\nl = [1,\n2,\ninf]", in_s([](T s) { s.numbers("l"); }),
       "a.toml:4: [s] l[2]: found inf, expected a finite number"},
      {"l = [1, 2.0]", [](T t) { t.integers("l"); }, "a.toml:1: l[1]: found 2.0, expected an integer"},
      {"l = ['a', 1]", [](T t) { t.strings("l"); }, "a.toml:1: l[1]: found 1, expected a string"},
      {"l = ['rk4', 'rk5']", [](T t) { t.choices("l", {"rk4"}); },
       "a.toml:1: l[1]: found the string \"rk5\", expected \"rk4\"; did you mean \"rk4\"?"},
      {"p = [[0, 0, 0],\n [1, nan, 0]]", [](T t) { t.vectors("p"); },
       "a.toml:2: p[1][1]: found nan, expected a finite number"},
      {"p = [[0, 0, 0], 1]", [](T t) { t.vectors("p"); },
       "a.toml:1: p[1]: found 1, expected an array of 3 numbers [x, y, z]"},
      {"f = [0, 3]", [](T t) { t.indices("f", 3, "particle"); },
       "a.toml:1: f[1]: found 3, expected the index of a particle, an integer from 0 to 2"},
      {"f = [-1]", [](T t) { t.indices("f", 3, "particle"); },
       "a.toml:1: f[0]: found -1, expected the index of a particle, an integer from 0 to 2"},
      {"f = [0]", [](T t) { t.indices("f", 0, "particle"); },
       "a.toml:1: f[0]: found 0, expected no index, as there is no particle"},
      {"[s]\nb = [[0, 1],\n[1, 2]]", in_s([](T s) { s.index_pairs("b", 2, "particle"); }),
       "a.toml:3: [s] b[1][1]: found 2, expected the index of a particle, an integer from 0 to 1"},
      {"b = [[0, 1, 1]]", [](T t) { t.index_pairs("b", 2, "particle"); },
       "a.toml:1: b[0]: found an array of 3 entries, expected a pair [i, j] of particle indices"},
      {"k = [1, 2]", [](T t) { t.number_or_list("k", 3, "spring"); },
       "a.toml:1: k: found an array of 2 entries, expected one number, or an array with one number per "
       "spring (3)"},
      {"k = 'x'", [](T t) { t.number_or_list("k", 3, "spring"); },
       "a.toml:1: k: found the string \"x\", expected one number, or an array with one number per spring "
       "(3)"},
      {"k = -1", [](T t) { t.number_or_list("k", 3, "spring", NumberRule::nonnegative); },
       "a.toml:1: k: found -1, expected a finite number >= 0"},
      {"k = [1, -1]", [](T t) { t.number_or_list("k", 2, "spring", NumberRule::nonnegative); },
       "a.toml:1: k[1]: found -1, expected a finite number >= 0"},
      {"k = 1.5", [](T t) { t.indices_or_names("k", 3, "particle", {"all"}); },
       "a.toml:1: k: found 1.5, expected the index of a particle or a name, or an array of these"},
      {"k = [0, 'al']", [](T t) { t.indices_or_names("k", 3, "particle", {"all"}); },
       "a.toml:1: k[1]: found the string \"al\", expected \"all\"; did you mean \"all\"?"},
      {"k = 3", [](T t) { t.indices_or_names("k", 3, "particle", {"all"}); },
       "a.toml:1: k: found 3, expected the index of a particle, an integer from 0 to 2"},
      {"b = 1", [](T t) { t.fail_missing("a", "an a", {"a"}); }, "a.toml: missing key \"a\", expected an a"},
      {"s = 1", [](T t) { t.table("s"); }, "a.toml:1: s: found 1, expected a section [s]"},
      {"[[s]]\n", [](T t) { t.table("s"); }, "a.toml:1: s: found an array of tables, expected a section [s]"},
      {"\n[s]\n", [](T t) { t.tables("s"); }, "a.toml:2: s: found a table, expected sections [[s]]"},
      {"s = [1]\n", [](T t) { t.tables("s"); },
       "a.toml:1: s: found an array of 1 entry, expected sections [[s]]"},
      {"[[s]]\nx = 1\n[[s]]\nx = 'q'\n", [](T t) { t.tables("s").at(1).number("x"); },
       "a.toml:4: [s[1]] x: found the string \"q\", expected a finite number"},
      {"[s.t]\nx = 'q'\n", [](T t) { t.table("s").table("t").number("x"); },
       "a.toml:2: [s.t] x: found the string \"q\", expected a finite number"},
  };
  for (const auto& [text, read, message] : cases) {
    EXPECT_EQ(error_of([&] { read(parse(text)); }), message) << text;
  }
}

TEST(CheckedTable, FindsTheFirstKeyThatNobodyKnows) {
  const auto message = [](const CheckedTable& t, const std::vector<std::string>& known) {
    const auto unknown = t.unknown_key(known);
    return unknown ? unknown->message : "none";
  };
  const std::vector<std::string> top = {"springs", "obstacle", "title"}, springs = {"stiffness", "damping"};
  EXPECT_EQ(message(parse("[springs]\ndamping = 1\nstifness = 1").table("springs"), springs),
            "a.toml:3: unknown key \"stifness\" in [springs]; did you mean \"stiffness\"?");
  EXPECT_EQ(message(parse("tilte = 'x'"), top),
            "a.toml:1: unknown key \"tilte\" at the top of the file; did you mean \"title\"?");
  EXPECT_EQ(message(parse("[spring]\nx = 1"), top),
            "a.toml:1: unknown section [spring]; did you mean \"springs\"?");
  EXPECT_EQ(message(parse("[[obstacles]]\nx = 1"), top),
            "a.toml:1: unknown section [[obstacles]]; did you mean \"obstacle\"?");
  EXPECT_EQ(message(parse("[[obstacle]]\n[[obstacle]]\ncolour = 1").tables("obstacle").at(1), {"radius"}),
            "a.toml:3: unknown key \"colour\" in [obstacle[1]]");
  EXPECT_EQ(message(parse("[springs]\nz = 1\na = 1\n").table("springs"), springs),
            "a.toml:2: unknown key \"z\" in [springs]")
      << "the first line comes first, not the first letter";
  EXPECT_EQ(message(parse("[springs]\ndamping = 1").table("springs"), springs), "none");
  EXPECT_TRUE(parse("tilte = 1").unknown_key(top)->has_suggestion);
  EXPECT_FALSE(parse("colour = 1").unknown_key(top)->has_suggestion);
}

TEST(CheckedTable, SeesThatAMissingKeyIsAMisspeltOne) {
  EXPECT_EQ(error_of([] { parse("[s]\n\nstifness = 1").table("s").number("stiffness"); }),
            "a.toml:3: unknown key \"stifness\" in [s]; did you mean \"stiffness\"?");
  EXPECT_EQ(error_of([] { parse("[partcles]\n").table("particles"); }),
            "a.toml:1: unknown section [partcles]; did you mean \"particles\"?");
  EXPECT_EQ(error_of([] { parse("[s]\nvolume = 1").table("s").number("stiffness"); }),
            "a.toml:1: [s]: missing key \"stiffness\", expected a number");
}

TEST(CheckedTable, ReportsSyntaxErrorsWithLineAndColumn) {
  EXPECT_THAT(error_of([] { parse("a = 1\nb = = 2\n"); }), HasSubstr("a.toml:2:5: TOML syntax error: "));
  EXPECT_THAT(error_of([] { parse("a = 1\na = 2\n"); }), HasSubstr("a.toml:2:"));
  EXPECT_THAT(error_of([] { parse("a = \"\xff\"\n"); }), HasSubstr("a.toml:1:"));
  EXPECT_THAT(error_of([] { parse("a = [1, 2\n"); }), HasSubstr("a.toml:"));
  EXPECT_THAT(error_of([] { parse("a = 99999999999999999999\n"); }), HasSubstr("a.toml:1:"));
  EXPECT_THAT(error_of([] { parse("a = " + std::string(100000, '[')); }), HasSubstr("a.toml:1:"));
}

TEST(CheckedTable, ReportsFilesThatCannotBeRead) {
  EXPECT_EQ(error_of([] { CheckedTable::parse_file("/nonexistent/b.toml"); }),
            "/nonexistent/b.toml: no such file");
  EXPECT_EQ(error_of([] { CheckedTable::parse_file("/"); }), "/: found a directory, expected a TOML file");
  EXPECT_EQ(error_of([] { CheckedTable::parse_file("/dev/null/b.toml"); }), "/dev/null/b.toml: no such file");
}

TEST(CheckedTable, ReadsFiles) {
  const auto path = std::filesystem::path(testing::TempDir()) / "checked_table_test.toml";
  std::ofstream(path) << "\xEF\xBB\xBF"
                      << "x = 1\r\n[s]\r\ny = 'é'\r\n";
  const auto t = CheckedTable::parse_file(path);
  EXPECT_EQ(t.source_name(), path.string());
  EXPECT_EQ(t.number("x"), 1.0);
  EXPECT_EQ(error_of([&] { t.table("s").number("y"); }),
            path.string() + ":3: [s] y: found the string \"é\", expected a finite number");
  std::ofstream(path, std::ios::trunc).close();
  EXPECT_TRUE(CheckedTable::parse_file(path).keys().empty());
  std::remove(path.c_str());
}

TEST(CheckedTable, PlacesMessagesOfCallers) {
  const auto t = parse("[s]\np = [[1, 2],\n [3, 4]]\n");
  const auto s = t.table("s");
  EXPECT_EQ(s.where("p", {1, 0}), "a.toml:3: [s] p[1][0]");
  EXPECT_EQ(s.where(), "a.toml:1: [s]");
  EXPECT_EQ(t.where(), "a.toml");
  EXPECT_EQ(s.where("absent"), "a.toml:1: [s] absent");
  EXPECT_EQ(error_of([&] { s.fail("p", {1}, "found a b, expected a c"); }),
            "a.toml:3: [s] p[1]: found a b, expected a c");
  EXPECT_EQ(error_of([&] { s.fail("p", "no"); }), "a.toml:2: [s] p: no");
}

/// The text of a tree with all of the document.
std::string copied(const CheckedTable& t) {
  TomlTree tree;
  tree.copy_all(t);
  return tree.text();
}

TEST(TomlTree, WritesACopyWithDefaultsThatReadsBack) {
  const auto t =
      parse("b = 1\na = 0.1\n[s]\nq = \"a\\\"\\n\\u0001\"\n[[o]]\nr = 1e-300\n[[o]]\nd = 1979-05-27\n");
  TomlTree tree;
  tree.copy_all(t);
  TomlTree s = tree.table("s");
  s.set("k", 1.0 / 3.0);
  s.set("v", Vec3<double>{0, -0.0, 1e22});
  s.set("l", std::vector<double>{1, 0.25});
  s.set("i", std::vector<std::int64_t>{4});
  s.set("p", std::vector<Vec3<double>>{{1, 2, 3}});
  tree.table("w").set("f", true);
  const std::string text = tree.text();
  EXPECT_EQ(text,
            "a = 0.1\nb = 1\n"
            "\n[[o]]\nr = 1e-300\n\n[[o]]\nd = 1979-05-27\n"
            "\n[s]\ni = [4]\nk = 0.3333333333333333\nl = [1.0, 0.25]\np = [[1.0, 2.0, 3.0]]\n"
            "q = \"a\\\"\\n\\u0001\"\nv = [0.0, -0.0, 1e+22]\n"
            "\n[w]\nf = true\n");
  const auto again = parse(text);
  EXPECT_EQ(copied(again), text);
  EXPECT_EQ(again.table("s").number("k"), 1.0 / 3.0);
  EXPECT_TRUE(std::signbit(again.table("s").vec3("v").y));
  EXPECT_EQ(again.table("s").string("q"), "a\"\n\x01");
  EXPECT_EQ(t.table("s").keys(), std::vector<std::string>{"q"}) << "the document is as it was";
}

TEST(TomlTree, WritesExtremeDoublesExactly) {
  const std::vector<double> values = {5e-324,     2.2250738585072014e-308, 1.7976931348623157e308,
                                      -0.1,       123456789012345680.0,    std::nextafter(1.0, 2.0),
                                      1e15 / 3.0, 9007199254740993.0};
  TomlTree tree;
  tree.set("x", values);
  EXPECT_EQ(parse(tree.text()).numbers("x"), values) << tree.text();
}

TEST(TomlTree, QuotesKeysThatAreNotBare) {
  const std::string text = copied(parse("\"\" = 1\n\"a b\" = 2\n\n[\"x.y\"]\nz = { } \n"));
  EXPECT_EQ(copied(parse(text)), text);
  EXPECT_EQ(parse(text).table("x.y").keys(), std::vector<std::string>{"z"});
}

TEST(CheckedTable, ReadsAHundredThousandVectors) {
  std::string text = "p = [\n";
  for (int i = 0; i < 100000; ++i) text += fmt::format("[{}, 0.5, 1e-3],\n", i);
  text += "]\n";
  const auto points = parse(text).vectors("p");
  ASSERT_EQ(points.size(), 100000u);
  EXPECT_EQ(points[99999], (Vec3<double>{99999, 0.5, 1e-3}));
}

}  // namespace
}  // namespace fw
