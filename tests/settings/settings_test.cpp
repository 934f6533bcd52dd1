#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "settings/description.hpp"
#include "settings/identity_text.hpp"
#include "settings/json_schema.hpp"
#include "settings/reader.hpp"
#include "settings/settings_page.hpp"
#include "text/toml_assignment.hpp"

namespace fw::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

enum class Colour { red, green };

struct Inner {
  double length = 1.0;
};
void declare(Archive& a, Inner& s) {
  a(setting("length", s.length).unit("m").positive().doc("of it"));
}

struct Sample {
  double ratio = 1.5;
  std::int64_t levels = 9;
  bool flag = true;
  std::string name = "x";
  Colour colour = Colour::green;
  Vec3<double> direction{1.0, 0.0, 0.0};
  std::vector<double> steps;
  std::vector<std::string> laws = {"a"};
  std::optional<double> given;
  std::int64_t only_selects = 3;
  Inner inner;
  std::optional<Inner> maybe;
  std::vector<Inner> list;
  std::optional<double> mass, density;
  std::int64_t quick_count = 2;
};
void declare(Archive& a, Sample& s) {
  a(setting("ratio", s.ratio).unit("1").above(1.0).quick().doc("of steps"));
  a(setting("levels", s.levels).integers(6, 100).quick_at_most(6));
  a(setting("flag", s.flag));
  a(setting("name", s.name));
  a(choice("colour", s.colour, {{"red", Colour::red}, {"green", Colour::green}}));
  a(setting("direction", s.direction));
  a(setting("steps", s.steps).required().not_empty().positive().or_sequence());
  a(setting("laws", s.laws).not_empty().choices({"a", "b"}));
  a(setting("given", s.given));
  a(setting("only_selects", s.only_selects).selects_cases());
  a.section({"inner", "An inner one."}, s.inner);
  a.optional_section({"maybe"}, s.maybe);
  a.sections({"list"}, s.list);
  a.one_of({{"mass", [&] { a(setting("mass", s.mass).positive()); }},
            {"density", [&] { a(setting("density", s.density).positive()); }}});
  a.quick_section([&] { a(setting("count", s.quick_count).at_least(1)); });
}

const std::string least = "steps = [1]\nmass = 2\n";

Sample read_sample(const std::string& text, bool is_quick = false) {
  Sample sample;
  read(CheckedTable::parse_text(text, "a.toml"), sample, is_quick);
  return sample;
}

std::string refusal(const std::string& text) {
  try {
    read_sample(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Settings, TakeTheFilesValuesAndTheVariablesAsDefaults) {
  const Sample s =
      read_sample(least +
                  "ratio = 2\ncolour = 'red'\ndirection = [0, 1, 2]\ngiven = -0.5\n[inner]\nlength = 4\n"
                  "[[list]]\n[[list]]\nlength = 7\n");
  EXPECT_EQ(s.ratio, 2.0);
  EXPECT_EQ(s.levels, 9);
  EXPECT_EQ(s.colour, Colour::red);
  EXPECT_EQ(s.direction, (Vec3<double>{0, 1, 2}));
  EXPECT_EQ(s.given, -0.5);
  EXPECT_EQ(s.inner.length, 4.0);
  EXPECT_FALSE(s.maybe);
  ASSERT_EQ(s.list.size(), 2u);
  EXPECT_EQ(s.list[0].length, 1.0);
  EXPECT_EQ(s.list[1].length, 7.0);
  EXPECT_EQ(s.mass, 2.0);
  EXPECT_FALSE(s.density);
  EXPECT_EQ(read_sample("mass = 1\nsteps = { from = 1, to = 4, count = 3 }").steps,
            (std::vector<double>{1, 2, 4}));
}

struct WithWord {
  int stages = 8;
  double fraction = 0.5;
};
void declare(Archive& a, WithWord& s) {
  a(setting("stages", s.stages).integers(2, 500).or_word("auto", 0));
  a(setting("fraction", s.fraction).above(0.0).up_to(1.0));
}

TEST(Settings, MayHaveAWordInThePlaceOfAnInteger) {
  const auto read_text = [](const std::string& text) {
    WithWord s;
    read(CheckedTable::parse_text(text, "a.toml"), s);
    return s;
  };
  EXPECT_EQ(read_text("").stages, 8);
  EXPECT_EQ(read_text("stages = 'auto'").stages, 0);
  EXPECT_EQ(read_text("stages = 5").stages, 5);
  EXPECT_EQ(identity_text(read_text("stages = 'auto'\nfraction = 1")), "fraction = 1.0\nstages = \"auto\"\n");
  EXPECT_THROW(read_text("stages = 0"), InputError);
  EXPECT_THROW(read_text("stages = 'aut'"), InputError);
  EXPECT_THROW(read_text("fraction = 0"), InputError);
  EXPECT_THROW(read_text("fraction = 1.5"), InputError);
  const std::string schema = json_schema(describe<WithWord>({.name = "w"}), {.title = "T"});
  EXPECT_THAT(schema, HasSubstr("\"const\": \"auto\""));
  EXPECT_THAT(schema, AllOf(HasSubstr("\"minimum\": 2"), HasSubstr("\"maximum\": 500"),
                            HasSubstr("\"exclusiveMinimum\": 0"), HasSubstr("\"maximum\": 1")));
  EXPECT_THAT(markdown_table(describe<WithWord>({.name = "w"}), "key"),
              AllOf(HasSubstr("integer 2…500, or `\"auto\"`"), HasSubstr("number > 0…1")));
}

/// Things and groups of them, whose settings depend on how many there are.
struct Things {
  std::size_t count = 0;
  std::vector<double> mass = {1.0};
};
void declare(Archive& a, Things& s) {
  a(setting("mass", s.mass).positive().or_one_per("thing", s.count));
}
struct Group {
  Things things;
  std::string name;
};
void declare(Archive& a, Group& s) {
  declare(a, s.things);
  a(setting("name", s.name));
}
struct Collection {
  std::int64_t count = 0;
  std::optional<Things> things;
  std::vector<Group> groups;
  std::optional<double> size, spacing;
};
void declare(Archive& a, Collection& s) {
  a(setting("count", s.count).required().integers(1, 9));
  Things fresh;
  fresh.count = static_cast<std::size_t>(s.count);
  a.section_or_sections({"things"}, s.things, fresh, {"things"}, s.groups, Group{fresh, "nobody"});
  a.one_of({{"size", [&] { a(setting("size", s.size)); }},
            {"spacing", [&] { a(setting("spacing", s.spacing)); }}});
}

Collection read_collection(const std::string& text, std::string* resolved = nullptr) {
  Collection s;
  const TomlTree tree = read(CheckedTable::parse_text(text, "a.toml"), s);
  if (resolved != nullptr) *resolved = tree.text();
  return s;
}

std::string refusal_of_collection(const std::string& text) {
  try {
    read_collection(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Settings, MayBeInOneSectionOrInManyAndDependOnWhatStandsBefore) {
  const std::string top = "count = 2\nsize = 1\n";
  std::string resolved;
  const Collection one = read_collection(top + "[things]\nmass = [1, 2]\n", &resolved);
  ASSERT_TRUE(one.things);
  EXPECT_EQ(one.things->mass, (std::vector<double>{1, 2}));
  EXPECT_TRUE(one.groups.empty());
  EXPECT_EQ(resolved, "count = 2\nsize = 1\n\n[things]\nmass = [1, 2]\n");
  const Collection many = read_collection(top + "[[things]]\nmass = 3\n[[things]]\nname = 'x'\n", &resolved);
  EXPECT_FALSE(many.things);
  ASSERT_EQ(many.groups.size(), 2u);
  EXPECT_EQ(many.groups[0].things.mass, std::vector<double>{3}) << "one number for all";
  EXPECT_EQ(many.groups[0].name, "nobody");
  EXPECT_EQ(many.groups[1].things.mass, std::vector<double>{1});
  EXPECT_EQ(resolved,
            "count = 2\nsize = 1\n\n[[things]]\nmass = 3\nname = \"nobody\"\n"
            "\n[[things]]\nmass = 1.0\nname = \"x\"\n");
  EXPECT_EQ(identity_text(one), "count = 2\nsize = 1.0\n\n[things]\nmass = [1.0, 2.0]\n");
  EXPECT_FALSE(read_collection(top).things);
  EXPECT_TRUE(read_collection(top + "things = []\n", &resolved).groups.empty());
  EXPECT_EQ(resolved, "count = 2\nsize = 1\nthings = []\n") << "as the file has it";

  EXPECT_EQ(refusal_of_collection(top + "[things]\nmass = [1, 2, 3]\n"),
            "a.toml:4: [things] mass: found an array of 3 entries, expected one number, or an array with one "
            "number "
            "per thing (2)");
  EXPECT_EQ(refusal_of_collection(top + "[[things]]\n[[things]]\nmass = [1, 0]\n"),
            "a.toml:5: [things[1]] mass[1]: found 0, expected a finite number > 0");
  EXPECT_EQ(refusal_of_collection(top + "things = 3\n"),
            "a.toml:3: things: found 3, expected a section [things]");
  EXPECT_EQ(refusal_of_collection(top + "[[things]]\nmas = 1\n"),
            "a.toml:4: unknown key \"mas\" in [things[0]]; did you mean \"mass\"?");
}

TEST(Settings, TellWhatIsMissingBeforeWhatMayDependOnIt) {
  EXPECT_EQ(refusal_of_collection("colour = 1\n"),
            "a.toml: missing key \"count\", expected an integer from 1 to 9");
  EXPECT_EQ(refusal_of_collection("coun = 1\nsize = 1\n"),
            "a.toml:1: unknown key \"coun\" at the top of the file; did you mean \"count\"?");
  EXPECT_EQ(refusal_of_collection("count = 1\nsize = 1\nspacing = 1\n"),
            "a.toml:3: spacing: found both of \"size\" and \"spacing\", expected exactly one");
}

TEST(Settings, QuickReplacesWhatHasAQuickRuleAndNothingElse) {
  EXPECT_EQ(read_sample(least).levels, 9);
  EXPECT_EQ(read_sample(least, true).levels, 6);
  EXPECT_EQ(read_sample(least + "[quick]\nlevels = 7\nratio = 3\n", true).levels, 7);
  EXPECT_EQ(read_sample(least + "[quick]\nlevels = 7\nratio = 3\n", true).ratio, 3.0);
  EXPECT_EQ(read_sample(least + "[quick]\nlevels = 7\nratio = 3\n").ratio, 1.5);
  EXPECT_EQ(refusal(least + "[quick]\nlevels = 5\n"),
            "a.toml:4: [quick] levels: found 5, expected an integer from 6 to 100");
}

TEST(Settings, RefuseWhatIsWrongByFileLineKeyFoundAndExpected) {
  EXPECT_EQ(refusal(least + "ratio = 1\n"), "a.toml:3: ratio: found 1, expected a finite number > 1");
  EXPECT_EQ(refusal(least + "ratio = nan\n"), "a.toml:3: ratio: found nan, expected a finite number > 1");
  EXPECT_EQ(refusal(least + "levels = 7.5\n"),
            "a.toml:3: levels: found 7.5, expected an integer from 6 to 100");
  EXPECT_EQ(refusal(least + "colour = 'gren'\n"),
            "a.toml:3: colour: found the string \"gren\", expected one of \"red\", \"green\"; did you mean "
            "\"green\"?");
  EXPECT_EQ(refusal(least + "laws = []\n"),
            "a.toml:3: laws: found an empty list, expected at least one entry");
  EXPECT_THAT(refusal(least + "laws = ['c']\n"), HasSubstr("laws[0]: found the string \"c\""));
  EXPECT_EQ(refusal(least + "rato = 3\n"),
            "a.toml:3: unknown key \"rato\" at the top of the file; did you mean \"ratio\"?");
  EXPECT_EQ(refusal(least + "[inner]\nlenght = 3\n"),
            "a.toml:4: unknown key \"lenght\" in [inner]; did you mean \"length\"?");
  EXPECT_EQ(refusal("mass = 1\nstep = [1]\n"),
            "a.toml:2: unknown key \"step\" at the top of the file; did you mean \"steps\"?");
  EXPECT_EQ(refusal("mass = 1\n"),
            "a.toml: missing key \"steps\", expected a list of finite numbers > 0, or { "
            "from, to, count }");
  EXPECT_THAT(refusal("steps = [1]\n"),
              HasSubstr("found none of \"mass\" and \"density\", expected exactly one"));
  EXPECT_THAT(refusal(least + "density = 1\n"), HasSubstr("found both of \"mass\" and \"density\""));
  EXPECT_THAT(refusal("mass = 1\nsteps = { from = 1, to = 4, count = 3, cont = 1 }"), HasSubstr("\"cont\""));
}

TEST(Settings, LeaveTheTableAsItIsAndResolveItWithAllDefaults) {
  const CheckedTable table = CheckedTable::parse_text(least + "ratio = 2\n", "a.toml");
  Sample sample;
  const std::string first = read(table, sample).text();
  EXPECT_THAT(first, AllOf(HasSubstr("ratio = 2\n"), HasSubstr("levels = 9\n"), HasSubstr("mass = 2\n"),
                           HasSubstr("[inner]\nlength = 1.0\n"),
                           HasSubstr("[quick]\ncount = 2\nlevels = 6\nratio = 2.0\n"),
                           Not(HasSubstr("maybe")), Not(HasSubstr("density"))));
  Sample again;
  EXPECT_EQ(read(table, again).text(), first);
  EXPECT_EQ(table.keys(), (std::vector<std::string>{"mass", "ratio", "steps"}));
  // The resolved text is a file of the same settings.
  Sample resolved;
  EXPECT_EQ(read(CheckedTable::parse_text(first, "b.toml"), resolved).text(), first);
  EXPECT_EQ(identity_text(resolved), identity_text(sample));
}

TEST(Settings, AreIdentifiedByEveryValueButWhatOnlySelectsCases) {
  const Sample sample = read_sample(least);
  const std::string text = identity_text(sample);
  const auto differs = [&](auto change) {
    Sample other = sample;
    change(other);
    return identity_text(other) != text;
  };
  EXPECT_TRUE(differs([](Sample& s) { s.ratio = 1.7; }));
  EXPECT_TRUE(differs([](Sample& s) { s.levels = 8; }));
  EXPECT_TRUE(differs([](Sample& s) { s.flag = false; }));
  EXPECT_TRUE(differs([](Sample& s) { s.name = "y"; }));
  EXPECT_TRUE(differs([](Sample& s) { s.colour = Colour::red; }));
  EXPECT_TRUE(differs([](Sample& s) { s.direction.z = -0.0; }));
  EXPECT_TRUE(differs([](Sample& s) { s.steps.push_back(2.0); }));
  EXPECT_TRUE(differs([](Sample& s) { s.laws.push_back("b"); }));
  EXPECT_TRUE(differs([](Sample& s) { s.given = 1.0; }));
  EXPECT_TRUE(differs([](Sample& s) { s.inner.length = 1.0 + 1e-15; }));
  EXPECT_TRUE(differs([](Sample& s) { s.maybe.emplace(); }));
  EXPECT_TRUE(differs([](Sample& s) { s.list.emplace_back(); }));
  EXPECT_TRUE(differs([](Sample& s) { s.mass = 3.0; }));
  EXPECT_FALSE(differs([](Sample& s) { s.only_selects = 4; }));
}

TEST(Settings, AreDescribedByASchemaAndATable) {
  const SectionDescription description = describe<Sample>({"sample"});
  const std::string schema = json_schema(description, {.title = "a sample"});
  EXPECT_THAT(schema, AllOf(HasSubstr("\"exclusiveMinimum\": 1"), HasSubstr("\"maximum\": 100"),
                            HasSubstr("\"additionalProperties\": false"), HasSubstr("\"required\"")));
  const std::string table = markdown_table(description, "key");
  EXPECT_THAT(table, AllOf(HasSubstr("| `ratio` |  | number > 1 | `1.5` | of steps |"),
                           HasSubstr("| `levels` |  | integer 6…100 | `9` |"),
                           HasSubstr("| `mass` | `mass` | number > 0 | one of `mass`, `density` |")));
}

TEST(SettingsTable, TakesValuesAsIfTheFileHadThemAndKeepsItsLines) {
  const CheckedTable file =
      CheckedTable::parse_text("x = 1\n[study]\nratio = 0.5\nmass = 1\nsteps = [1]\n", "a.toml");
  const CheckedTable changed = file.table("study").with({{"levels", std::int64_t{8}}}, "a.toml (levels=8)");
  Sample sample;
  EXPECT_THAT([&] { read(changed, sample); },
              ThrowsMessage<InputError>(
                  "a.toml (levels=8):3: [study] ratio: found 0.5, expected a finite number > 1"));
  const CheckedTable twice = changed.with({{"ratio", 3.0}}, "b.toml");
  read(twice, sample);
  EXPECT_EQ(sample.levels, 8);
  EXPECT_EQ(sample.ratio, 3.0);
  EXPECT_FALSE(file.table("study").has("levels"));
}

}  // namespace
}  // namespace fw::settings
