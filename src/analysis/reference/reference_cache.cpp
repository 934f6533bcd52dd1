#include "analysis/reference/reference_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "system/sha256.hpp"

namespace fw::analysis {
namespace {

/// Raise it whenever the digits that come out of the extrapolation may change.
constexpr std::string_view algorithm_version = "gragg-extrapolation 2";
constexpr std::string_view header = "federwerk reference 1";

/// 36 significant digits identify a binary128 number.
std::string digits(const Float128& value) {
  return value.str(35, std::ios::scientific);
}

void describe(std::string& text, const ExtrapolationSettings& settings) {
  text +=
      fmt::format("tolerance {:a} least_steps {} {} limits {} {}\n", settings.tolerance, settings.least_steps,
                  settings.least_steps_per_output, settings.step_limit, settings.forced_step_limit);
  for (std::size_t j = 0; j < settings.tableau.rows(); ++j) {
    text += fmt::format("row {}", settings.tableau.substeps[j]);
    for (const Float128& divisor : settings.tableau.divisor[j]) text += fmt::format(" {}", digits(divisor));
    text += "\n";
  }
}

std::string cache_key(std::string_view identity, const Ivp& ivp, std::span<const double> times,
                      const ReferenceOptions& options) {
  std::string text = fmt::format("{}\nt0 {:a}\n", algorithm_version, ivp.t0);
  for (const Float128& component : initial_state_extended(ivp))
    text += fmt::format("y0 {}\n", digits(component));
  for (const double time : times) text += fmt::format("time {:a}\n", time);
  describe(text, options.fine);
  describe(text, options.coarse);
  text += fmt::format("accuracy {:a}\nidentity {}", options.accuracy, identity);
  return sha256_hex(text);
}

std::string to_text(const std::string& key, const ReferenceSolution& reference) {
  std::string text = fmt::format("{}\nkey {}\nstates {}\n", header, key, reference.states.size());
  for (const ReferenceState& state : reference.states) {
    text += fmt::format("time {:a} components {}\n", state.time, state.value.size());
    for (std::size_t i = 0; i < state.value.size(); ++i) {
      text += fmt::format("{} {}\n", digits(state.value[i]), digits(state.error[i]));
    }
  }
  return text + fmt::format("sha256 {}\n", sha256_hex(text));
}

/// The reference in `text`, or nothing where anything in it is not as `to_text` wrote it for these times.
std::optional<ReferenceSolution> from_text(const std::string& text, const std::string& key, std::size_t size,
                                           std::span<const double> times) {
  const std::size_t checksum = text.rfind("sha256 ");
  if (checksum == std::string::npos) return std::nullopt;
  const std::string body = text.substr(0, checksum);
  if (text.substr(checksum) != fmt::format("sha256 {}\n", sha256_hex(body))) return std::nullopt;
  if (!body.starts_with(fmt::format("{}\nkey {}\nstates {}\n", header, key, times.size())))
    return std::nullopt;

  std::istringstream input(body);
  std::string word, value, error;
  for (int line = 0; line < 3; ++line) std::getline(input, word);
  ReferenceSolution reference;
  try {
    for (const double time : times) {
      std::string time_text;
      std::size_t count = 0;
      if (!(input >> word >> time_text >> word >> count)) return std::nullopt;
      if (time_text != fmt::format("{:a}", time) || count != size) return std::nullopt;
      ReferenceState state{time, {}, {}};
      for (std::size_t i = 0; i < count; ++i) {
        if (!(input >> value >> error)) return std::nullopt;
        state.value.emplace_back(value);
        state.error.emplace_back(error);
      }
      reference.states.push_back(std::move(state));
    }
  } catch (const std::runtime_error&) {  // not a number
    return std::nullopt;
  }
  reference.cached = true;
  return reference;
}

/// Writes to a name of its own and renames. What fails leaves no trace: the cache is a convenience.
void keep(const std::filesystem::path& file, const std::string& text) {
  static std::atomic<unsigned> counter{0};
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  if (failure) return;
  std::filesystem::path temporary = file;
  temporary += fmt::format(".{}.{}.tmp", ::getpid(), counter.fetch_add(1));
  {
    std::ofstream output(temporary, std::ios::binary);
    output << text;
    output.close();
    if (!output) {
      std::filesystem::remove(temporary, failure);
      return;
    }
  }
  std::filesystem::rename(temporary, file, failure);
  if (failure) std::filesystem::remove(temporary, failure);
}

}  // namespace

ReferenceCache::ReferenceCache(std::filesystem::path directory) : directory_(std::move(directory)) {}

std::filesystem::path ReferenceCache::default_directory() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value != nullptr ? value : "");
  };
  if (const auto own = variable("FEDERWERK_CACHE"); !own.empty()) return own;
  if (const auto cache = variable("XDG_CACHE_HOME"); !cache.empty()) return cache / "federwerk";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "federwerk";
  return {};
}

std::filesystem::path ReferenceCache::file(std::string_view identity, const Ivp& ivp,
                                           std::span<const double> times,
                                           const ReferenceOptions& options) const {
  return directory_ / fmt::format("{}.txt", cache_key(identity, ivp, times, options));
}

ReferenceSolution ReferenceCache::certified(std::string_view identity, const Ivp& ivp,
                                            std::span<const double> times,
                                            const ReferenceOptions& options) const {
  if (directory_.empty()) return certified_reference(ivp, times, options);
  const std::filesystem::path path = file(identity, ivp, times, options);
  const std::string key = path.stem().string();
  if (std::ifstream input(path, std::ios::binary); input) {
    std::ostringstream text;
    text << input.rdbuf();
    if (auto reference = from_text(text.str(), key, initial_state_extended(ivp).size(), times))
      return *reference;
  }
  ReferenceSolution reference = certified_reference(ivp, times, options);
  if (reference.status.ok()) keep(path, to_text(key, reference));
  return reference;
}

ReferenceSolution ReferenceCache::of(const Problem& problem, std::span<const double> times,
                                     const ReferenceOptions& options) const {
  if (problem.exact) return reference(problem, times, options);
  return certified(fmt::format("{}({})", problem.name, problem.parameters), problem.ivp, times, options);
}

}  // namespace fw::analysis
