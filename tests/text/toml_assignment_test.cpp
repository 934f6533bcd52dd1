#include "text/toml_assignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "text/checked_table.hpp"

namespace fw {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* document =
    "a = 1\nlist = [1, 2, 3]\n[t]\nx = 'old'\n[[p]]\nname = 'one'\n[[p]]\nname = 'two'\n";

CheckedTable with(const std::vector<TomlAssignment>& assignments) {
  return CheckedTable::parse_text(document, "doc").with(assignments, "doc");
}

TEST(TomlAssignment, ReplacesValuesAndAddsMissingOnesWithTheirTables) {
  const CheckedTable table = with({{"a", 0.1},
                                   {"t.x", std::string("new \"text\"")},
                                   {"t.y.z", true},
                                   {"p[1].name", std::string("zwei")},
                                   {"p[0].parameters.k", std::int64_t{7}},
                                   {"list[2]", 2.5}});
  EXPECT_EQ(table.number("a"), 0.1);
  EXPECT_EQ(table.table("t").string("x"), "new \"text\"");
  EXPECT_TRUE(table.table("t").table("y").boolean("z"));
  EXPECT_EQ(table.tables("p")[0].string("name"), "one");
  EXPECT_EQ(table.tables("p")[0].table("parameters").integer("k"), 7);
  EXPECT_EQ(table.tables("p")[1].string("name"), "zwei");
  EXPECT_EQ(table.numbers("list"), (std::vector<double>{1, 2, 2.5}));
}

TEST(TomlAssignment, KeepsEveryBitOfANumber) {
  EXPECT_EQ(with({{"a", 0.1 + 0.2}}).number("a"), 0.1 + 0.2);
}

TEST(TomlAssignment, RefusesPathsThatLeadNowhere) {
  const auto refuses = [](const std::string& path, const std::string& why) {
    EXPECT_THAT([&] { with({{path, 1.0}}); }, ThrowsMessage<InputError>(HasSubstr(why))) << path;
  };
  for (const char* path :
       {"", ".", "a.", ".a", "a..b", "[0]", "p[", "p[]", "p[-1]", "p[x]", "a b", "p[0]name"}) {
    refuses(path, "expected keys and indices");
  }
  refuses("p[2].name", "found index 2, expected less than 2");
  refuses("a.b", "what should hold \"b\" is not a table");
  refuses("t[0]", "is no list");
}

}  // namespace
}  // namespace fw
