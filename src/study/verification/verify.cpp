#include "study/verification/verify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "analysis/verification/verification.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using analysis::PropertyCheck;
using analysis::VerificationPart;

/// The independent solver that end states are held against.
constexpr const char* oracle_for_agreement = "sundials:cvode_bdf";

struct Verification {
  std::string call;
  std::shared_ptr<const Integrator> integrator;
  schemes::SchemeData data;  ///< the coefficients of the call, with its options
  std::shared_ptr<const Integrator> oracle;
};

std::string in_words(const PropertyCheck& check) {
  std::vector<std::string> parts;
  const auto add = [&](const char* what, const std::string& value) {
    if (!value.empty()) parts.push_back(fmt::format("{} {}", what, value));
  };
  add("claimed", check.claimed);
  add("derived", check.derived);
  add("measured", check.measured);
  if (!check.reason.empty()) parts.push_back(check.reason);
  return fmt::format("{}: {}", check.property, fmt::join(parts, ", "));
}

/// One column of text over the properties.
Column column_of_checks(const char* name, const std::vector<PropertyCheck>& checks,
                        std::string (*text)(const PropertyCheck&)) {
  std::vector<std::string> values;
  for (const PropertyCheck& check : checks) values.push_back(text(check));
  return {name, "", std::move(values), {}, {}};
}

CaseResult run_verification(const Verification& scheme, const std::vector<VerificationPart>& parts,
                            const RunContext& context) {
  std::vector<PropertyCheck> checks;
  for (const VerificationPart& part : parts) {
    if (context.is_interrupted()) throw Interrupted{};
    analysis::run_part(part, {*scheme.integrator, scheme.data, scheme.oracle.get()}, checks);
  }
  const auto count = [&](Verdict verdict) {
    return std::count_if(checks.begin(), checks.end(),
                         [verdict](const PropertyCheck& check) { return check.verdict == verdict; });
  };
  const std::int64_t hold = count(Verdict::holds), fail = count(Verdict::fails);
  std::vector<std::string> failing, reasons;
  for (const PropertyCheck& check : checks) {
    if (check.verdict != Verdict::fails) continue;
    failing.push_back(check.property);
    reasons.push_back(in_words(check));
  }
  CaseResult result;
  result.verdict = fail > 0 ? Verdict::fails : hold > 0 ? Verdict::holds : Verdict::not_applicable;
  result.reason = fail > 0   ? fmt::format("{}", fmt::join(reasons, "; "))
                  : hold > 0 ? fmt::format("{} properties hold", hold)
                             : "nothing is claimed that could be checked";
  result.columns = {
      column_of_checks("property", checks, [](const PropertyCheck& check) { return check.property; }),
      column_of_checks("claimed", checks, [](const PropertyCheck& check) { return check.claimed; }),
      column_of_checks("derived", checks, [](const PropertyCheck& check) { return check.derived; }),
      column_of_checks("measured", checks, [](const PropertyCheck& check) { return check.measured; }),
      column_of_checks("verdict", checks,
                       [](const PropertyCheck& check) { return std::string(to_string(check.verdict)); }),
      column_of_checks("reason", checks, [](const PropertyCheck& check) { return check.reason; })};
  result.summary = {{"method", "", scheme.call},
                    {"hold", "1", hold},
                    {"fail", "1", fail},
                    {"not_applicable", "1", static_cast<std::int64_t>(checks.size()) - hold - fail},
                    {"failing", "", fmt::format("{}", fmt::join(failing, "; "))},
                    {"verdict", "", std::string(to_string(result.verdict))},
                    {"reason", "", result.reason}};
  return result;
}

/// Every scheme of our own that has a fixed step.
std::vector<std::string> own_schemes(const Catalog& catalog) {
  std::vector<std::string> names;
  for (const std::string& name : catalog.method_names()) {
    const std::unique_ptr<Integrator> integrator = catalog.method(name);
    const MethodInfo& info = integrator->info();
    if (info.has_fixed_step && info.family != "oracle") names.push_back(name);
  }
  return names;
}

/// The parts of those names, in the order of the list of parts.
std::vector<VerificationPart> read_parts(const CheckedTable& table) {
  std::vector<std::string> names;
  for (const VerificationPart& part : analysis::verification_parts()) names.push_back(part.name);
  const std::vector<std::string> wanted = table.strings_or("parts", names);
  if (wanted.empty()) table.fail("parts", "found an empty list, expected at least one part");
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (std::find(names.begin(), names.end(), wanted[i]) != names.end()) continue;
    table.fail("parts", {i},
               fmt::format("found \"{}\", expected one of {}", wanted[i], fmt::join(names, ", ")));
  }
  std::vector<VerificationPart> parts;
  for (const VerificationPart& part : analysis::verification_parts()) {
    if (std::find(wanted.begin(), wanted.end(), part.name) != wanted.end()) parts.push_back(part);
  }
  return parts;
}

/// So many of them, evenly spread over the list.
std::vector<std::string> thin_out(const std::vector<std::string>& calls, std::size_t most) {
  if (calls.size() <= most) return calls;
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < most; ++k) kept.push_back(calls[k * calls.size() / most]);
  return kept;
}

void read_verify(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  std::vector<std::string> calls = spec.has("methods") ? read_method_patterns(spec, catalog)
                                                       : spec.strings_or("methods", own_schemes(catalog));
  const std::vector<VerificationPart> parts = read_parts(spec.table_or_empty("verify"));
  const std::int64_t most = spec.table_or_empty("quick").integer_or("methods", 8, 1);
  if (quick) calls = thin_out(calls, static_cast<std::size_t>(most));
  std::vector<std::string> names;
  for (const VerificationPart& part : parts) names.push_back(part.name);
  const std::shared_ptr<const Integrator> oracle = catalog.method(oracle_for_agreement);
  for (const std::string& call : calls) {
    const auto scheme = std::make_shared<const Verification>(
        Verification{call, catalog.method(call), catalog.theory(call).coefficients, oracle});
    plan.cases.push_back(
        {.id = group_name(call),
         .identity = fmt::format("verify\nmethod = {}\nparts = {}\n", call, fmt::join(names, " ")),
         .run = [scheme,
                 parts](const RunContext& context) { return run_verification(*scheme, parts, context); },
         .facts = {{"method", "", call}}});
  }
}

}  // namespace

StudyKind verify_kind() {
  return {.name = "verify",
          .title = "Verification",
          .description =
              "claimed properties of schemes against their coefficients and their running code: orders, "
              "stability, symplecticity, conservation, step control, agreement with an oracle",
          .read = read_verify};
}

}  // namespace fw::study
