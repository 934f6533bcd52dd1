#include <gtest/gtest.h>
#include <sys/resource.h>

#include "catalog/builtin_catalog.hpp"
#include "study/energy/energy_observer.hpp"
#include "study_of_text.hpp"

// Not for the sanitizer run, whose own memory would be measured.

namespace fw::study {
namespace {

/// Peak of resident memory of this process [bytes].
std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string spec(std::uint64_t steps) {
  return "kind = \"energy\"\ntitle = \"test\"\nmethods = [\"velocity_verlet\"]\n[energy]\nsteps = "
         "[0.2]\nstep_count = " +
         std::to_string(steps) + "\n[[problem]]\nname = \"harmonic_oscillator\"\n";
}

TEST(Energy, StreamsTwoMillionStepsInConstantMemory) {
  const catalog::BuiltinCatalog catalog;
  run_study(spec(1000), catalog);  // what is allocated once
  const std::size_t before = peak_memory();
  const StudyResult result = run_study(spec(2'000'000), catalog);
  const std::size_t growth = peak_memory() - before;
  const CaseResult& entry = result.cases.front();
  EXPECT_EQ(entry.verdict, Verdict::holds) << entry.reason;
  EXPECT_EQ(figure<std::int64_t>(entry, "steps_taken"), 2'000'000);
  EXPECT_LT(growth, 2U * 1024 * 1024) << "two bytes per step would be 4 MB, a state of 16 bytes 32 MB";
}

}  // namespace
}  // namespace fw::study
