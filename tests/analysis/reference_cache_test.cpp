#include "analysis/reference/reference_cache.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "problems/every_problem.hpp"

namespace fw::analysis {
namespace {

namespace fs = std::filesystem;
using namespace fw::problems;

class ReferenceCacheOnDisk : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "federwerk_cache_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    directory = pattern;
  }
  void TearDown() override {
    fs::permissions(directory, fs::perms::owner_all);
    fs::remove_all(directory);
  }

  static void expect_same(const ReferenceSolution& a, const ReferenceSolution& b) {
    ASSERT_EQ(a.states.size(), b.states.size());
    for (std::size_t n = 0; n < a.states.size(); ++n) {
      EXPECT_EQ(a.states[n].time, b.states[n].time);
      EXPECT_EQ(a.states[n].value, b.states[n].value);  // every bit
      EXPECT_EQ(a.states[n].error, b.states[n].error);
    }
  }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  fs::path directory;
  Problem problem = driven_duffing();
  std::vector<double> times = {0.1, 1.0 / 3.0};
};

TEST_F(ReferenceCacheOnDisk, GivesBackEveryBitThatWasComputed) {
  const ReferenceCache cache(directory / "made" / "on_demand");
  const auto computed = cache.of(problem, times);
  const auto cached = cache.of(problem, times);
  ASSERT_TRUE(computed.status.ok());
  EXPECT_FALSE(computed.cached);
  EXPECT_TRUE(cached.cached);
  EXPECT_TRUE(cached.status.ok());
  EXPECT_EQ(cached.work.rhs_evaluations, 0u);
  expect_same(computed, cached);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(directory / "made" / "on_demand"))
    files += 1;
  EXPECT_EQ(files, 1u);  // no temporary files are left
}

TEST_F(ReferenceCacheOnDisk, ComputesAgainWhatAnythingItDependsOnChanges) {
  const ReferenceCache cache(directory);
  EXPECT_FALSE(cache.certified("a", problem.ivp, times).cached);
  EXPECT_TRUE(cache.certified("a", problem.ivp, times).cached);
  EXPECT_FALSE(cache.certified("b", problem.ivp, times).cached);
  Ivp moved = problem.ivp;
  moved.y0[0] = std::nextafter(moved.y0[0], 2.0);
  EXPECT_FALSE(cache.certified("a", moved, times).cached);
  Ivp later = problem.ivp;
  later.t0 = 0.01;
  EXPECT_FALSE(cache.certified("a", later, times).cached);
  const std::vector<double> other = {0.1, 0.34};
  EXPECT_FALSE(cache.certified("a", problem.ivp, other).cached);
  ReferenceOptions options;
  options.fine.tolerance *= 2;
  EXPECT_FALSE(cache.certified("a", problem.ivp, times, options).cached);
  EXPECT_FALSE(cache.of(driven_duffing({{"mass", 1.25}}), times).cached);
  EXPECT_TRUE(cache.certified("a", problem.ivp, times).cached);
}

TEST_F(ReferenceCacheOnDisk, IgnoresAndRepairsCorruptAndForeignFiles) {
  const ReferenceCache cache(directory);
  const auto computed = cache.certified("a", problem.ivp, times);
  const fs::path file = cache.file("a", problem.ivp, times);
  const std::string intact = read(file);
  ASSERT_FALSE(intact.empty());
  std::string one_digit = intact;
  char& digit = one_digit[one_digit.find('.', one_digit.find("components")) + 20];
  digit = digit == '5' ? '6' : '5';
  cache.certified("b", problem.ivp, times);
  const std::string of_another = read(cache.file("b", problem.ivp, times));
  for (const std::string& damaged : {one_digit, intact.substr(0, intact.size() / 2), std::string(),
                                     of_another, std::string("\0\xff garbage", 10), intact + "more"}) {
    std::ofstream(file, std::ios::trunc | std::ios::binary) << damaged;
    const auto again = cache.certified("a", problem.ivp, times);
    EXPECT_FALSE(again.cached) << damaged.size();
    expect_same(computed, again);
    EXPECT_EQ(read(file), intact);
  }
  EXPECT_TRUE(cache.certified("a", problem.ivp, times).cached);
}

TEST_F(ReferenceCacheOnDisk, WorksWithoutADirectoryItCanWriteTo) {
  std::ofstream(directory / "file") << "in the way";
  const ReferenceCache blocked(directory / "file" / "below");
  const auto computed = blocked.of(problem, times);
  EXPECT_TRUE(computed.status.ok());
  EXPECT_FALSE(blocked.of(problem, times).cached);
  const ReferenceCache nowhere{fs::path()};
  expect_same(computed, nowhere.of(problem, times));
  EXPECT_FALSE(nowhere.of(problem, times).cached);
}

TEST_F(ReferenceCacheOnDisk, DoesNotKeepFailures) {
  ReferenceOptions short_of_steps;
  short_of_steps.fine.step_limit = 3;
  const ReferenceCache cache(directory);
  EXPECT_FALSE(cache.certified("a", problem.ivp, times, short_of_steps).status.ok());
  EXPECT_TRUE(fs::is_empty(directory));
}

TEST_F(ReferenceCacheOnDisk, DoesNotKeepClosedForms) {
  const ReferenceCache cache(directory);
  EXPECT_EQ(cache.of(kepler(), times).source, ReferenceSource::exact);
  EXPECT_TRUE(fs::is_empty(directory));
}

TEST(ReferenceCacheDirectory, FollowsTheEnvironmentInItsOrder) {
  struct Saved {  // puts the environment back
    std::string name;
    std::optional<std::string> value;
    explicit Saved(const char* variable) : name(variable) {
      if (const char* now = std::getenv(variable)) value = now;
    }
    ~Saved() { value ? ::setenv(name.c_str(), value->c_str(), 1) : ::unsetenv(name.c_str()); }
  };
  const Saved own("FEDERWERK_CACHE"), xdg("XDG_CACHE_HOME"), home("HOME");
  ::setenv("FEDERWERK_CACHE", "/a", 1);
  ::setenv("XDG_CACHE_HOME", "/b", 1);
  ::setenv("HOME", "/c", 1);
  EXPECT_EQ(ReferenceCache::default_directory(), "/a");
  ::unsetenv("FEDERWERK_CACHE");
  EXPECT_EQ(ReferenceCache::default_directory(), "/b/federwerk");
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(ReferenceCache::default_directory(), "/c/.cache/federwerk");
  ::unsetenv("HOME");
  EXPECT_TRUE(ReferenceCache::default_directory().empty());
}

}  // namespace
}  // namespace fw::analysis
