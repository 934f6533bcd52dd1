#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "analysis/verification/verification.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "catalog/methods.hpp"
#include "core/error.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"

namespace fw::app {

namespace {

using analysis::Finding;
using analysis::PropertyCheck;

constexpr const char* oracle_for_agreement = "sundials:cvode_bdf";

/// The findings on one method.
struct Verification {
  std::string method;
  std::vector<PropertyCheck> checks;
};

std::string_view to_string(Finding finding) {
  switch (finding) {
    case Finding::holds:
      return "holds";
    case Finding::fails:
      return "fails";
    case Finding::not_applicable:
      break;
  }
  return "not applicable";
}

Verification verify_method(const std::string& call) {
  const auto open = call.find('[');
  const catalog::MethodEntry& entry = catalog::find_method(call.substr(0, open));
  const std::unique_ptr<Integrator> integrator = catalog::make_method(call);
  const std::unique_ptr<Integrator> oracle = catalog::make_method(oracle_for_agreement);
  try {
    return {call, analysis::verify({*integrator, entry.data, oracle.get()})};
  } catch (const std::exception& error) {
    // A scheme that throws where it should return a Status has failed; the others go on.
    return {call, {{.property = "runs", .finding = Finding::fails, .reason = error.what()}}};
  }
}

/// The methods that were verified before the user interrupted, in the order of `calls`.
std::vector<Verification> verify_all(const std::vector<std::string>& calls, unsigned jobs,
                                     const std::atomic<bool>& interrupted) {
  std::vector<Verification> results(calls.size());
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex output;
  ProgressBar bar("schemes");
  const auto work = [&] {
    for (std::size_t i = next++; i < calls.size() && !interrupted; i = next++) {
      results[i] = verify_method(calls[i]);
      const std::size_t finished = ++done;
      const std::lock_guard lock(output);
      bar.update(static_cast<double>(finished) / static_cast<double>(calls.size()),
                 static_cast<double>(finished), calls[i]);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned k = 1; k < jobs; ++k) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  bar.clear();
  std::erase_if(results, [](const Verification& result) { return result.method.empty(); });
  return results;
}

std::string table(const std::vector<Verification>& results, bool all) {
  using text::TextTable;
  std::vector<std::string> method, property, claimed, derived, measured, verdict, reason;
  std::size_t holds = 0, fails = 0, skipped = 0;
  for (const Verification& result : results) {
    for (const PropertyCheck& check : result.checks) {
      ++(check.finding == Finding::holds ? holds : check.finding == Finding::fails ? fails : skipped);
      if (check.finding == Finding::not_applicable && !all) continue;
      method.push_back(result.method);
      property.push_back(check.property);
      claimed.push_back(check.claimed);
      derived.push_back(check.derived.size() > 28 ? check.derived.substr(0, 25) + "..." : check.derived);
      measured.push_back(check.measured);
      verdict.emplace_back(to_string(check.finding));
      reason.push_back(check.reason);
    }
  }
  TextTable text;
  text.add_column("method", TextTable::Align::left, method);
  text.add_column("property", TextTable::Align::left, property);
  text.add_column("claimed", TextTable::Align::left, claimed);
  text.add_column("derived", TextTable::Align::left, derived);
  text.add_column("measured", TextTable::Align::left, measured);
  text.add_column("verdict", TextTable::Align::left, verdict);
  text.add_column("reason", TextTable::Align::left, reason);
  return text.text() + fmt::format("\n{} methods: {} verdicts hold, {} fail, {} not applicable\n",
                                   results.size(), holds, fails, skipped);
}

std::string json(const std::vector<Verification>& results) {
  text::JsonWriter writer;
  writer.begin_array();
  for (const Verification& result : results) {
    for (const PropertyCheck& check : result.checks) {
      writer.begin_object().key("method").value(result.method).key("property").value(check.property);
      writer.key("claimed").value(check.claimed).key("derived").value(check.derived);
      writer.key("measured").value(check.measured).key("verdict").value(to_string(check.finding));
      writer.key("reason").value(check.reason).end_object();
    }
  }
  writer.end_array();
  return writer.text() + "\n";
}

struct VerifyArguments {
  std::vector<std::string> methods{};
  bool json = false;
  bool all = false;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

int verify(const VerifyArguments& arguments) {
  std::vector<std::string> calls = arguments.methods;
  if (calls.empty()) {
    for (const catalog::MethodEntry& entry : catalog::methods()) {
      if (entry.info().has_fixed_step && entry.info().family != "oracle") calls.push_back(entry.name);
    }
  }
  for (const std::string& call : calls)
    catalog::make_method(call);  // an unknown name ends before anything runs
  const std::atomic<bool>& interrupted = install_interrupt_flag();
  const std::vector<Verification> results = verify_all(calls, arguments.jobs, interrupted);
  fmt::print("{}", arguments.json ? json(results) : table(results, arguments.all));
  if (results.size() < calls.size()) {
    fmt::print(stderr, "federwerk: interrupted: {} of {} methods were verified\n", results.size(),
               calls.size());
    return exit_failure;
  }
  for (const Verification& result : results) {
    for (const PropertyCheck& check : result.checks) {
      if (check.finding == Finding::fails) return exit_verdict_fails;
    }
  }
  return exit_success;
}

}  // namespace

void add_verify_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "Checks the claimed properties of the schemes: order, stability, symplecticity, conservation, ...");
  auto arguments = std::make_shared<VerifyArguments>();
  command
      ->add_option("--method", arguments->methods,
                   "Only these methods (default: all our own; oracles only if named)")
      ->type_name("NAME");
  command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--all", arguments->all, "Prints properties that do not apply as well");
  command->add_option("--jobs", arguments->jobs, "Schemes checked at the same time")
      ->check(CLI::Range(1u, 1024u))
      ->type_name("N");
  command->callback([arguments, &action] { action = [arguments] { return verify(*arguments); }; });
}

}  // namespace fw::app
