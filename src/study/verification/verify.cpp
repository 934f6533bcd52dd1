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
using settings::Archive;
using settings::setting;

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

/// The row of the summary.
struct Row {
  std::string method;
  std::int64_t hold = 0, fail = 0, not_applicable = 0;
  std::string failing;
};

void declare(SummaryRow& a, const Row& row) {
  a("method", "", row.method, "as in the study, with options");
  a("hold", "1", row.hold, "properties that hold");
  a("fail", "1", row.fail, "properties that fail");
  a("not_applicable", "1", row.not_applicable,
    "properties that are not claimed or have no meaning for the scheme");
  a("failing", "", row.failing, "the properties that fail");
}

CaseResult run_verification(const Verification& scheme, const std::vector<VerificationPart>& parts,
                            const RunContext& context) {
  std::vector<PropertyCheck> checks;
  for (const VerificationPart& part : parts) {
    context.check();
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
  result.summary = cells_of(Row{.method = scheme.call,
                                .hold = hold,
                                .fail = fail,
                                .not_applicable = static_cast<std::int64_t>(checks.size()) - hold - fail,
                                .failing = fmt::format("{}", fmt::join(failing, "; "))});
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

std::vector<std::string> part_names() {
  std::vector<std::string> names;
  for (const VerificationPart& part : analysis::verification_parts()) names.push_back(part.name);
  return names;
}

/// The parts of those names, in the order of the list of parts.
std::vector<VerificationPart> parts_of(const std::vector<std::string>& wanted) {
  std::vector<VerificationPart> parts;
  for (const VerificationPart& part : analysis::verification_parts()) {
    if (std::find(wanted.begin(), wanted.end(), part.name) != wanted.end()) parts.push_back(part);
  }
  return parts;
}

/// The keys of [verify].
struct Settings {
  std::vector<std::string> parts = part_names();
};

void declare(Archive& a, Settings& s) {
  a(setting("parts", s.parts).not_empty().choices(part_names()).default_text("all").doc("what is checked"));
}

struct Spec {
  std::optional<std::vector<std::string>> methods;
  std::vector<std::string> without;
  Settings settings;
  std::int64_t quick_methods = 8;
};

void declare(Archive& a, Spec& spec) {
  a(setting("methods", spec.methods)
        .not_empty()
        .names_of("methods")
        .default_text("every scheme of our own with a fixed step")
        .doc("names, calls with options or patterns (`\"*\"`); foreign solvers may be named"));
  a(setting("without", spec.without).names_of("methods").doc("methods or patterns that are taken out again"));
  a.section({"verify", "What is checked."}, spec.settings);
  a.quick_section([&] {
    a(setting("methods", spec.quick_methods)
          .at_least(1)
          .doc("at most so many schemes, evenly spread over the list"));
  });
}

/// So many of them, evenly spread over the list.
std::vector<std::string> thin_out(const std::vector<std::string>& calls, std::size_t most) {
  if (calls.size() <= most) return calls;
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < most; ++k) kept.push_back(calls[k * calls.size() / most]);
  return kept;
}

void plan_verify(const Spec& spec, const StudyInput& input, Plan& plan) {
  const Catalog& catalog = input.catalog;
  const std::vector<std::string> patterns = spec.methods ? *spec.methods : own_schemes(catalog);
  if (!spec.methods) TomlTree(input.resolved).set("methods", patterns);
  std::vector<std::string> calls = expanded({patterns, spec.without}, input);
  if (input.is_quick) calls = thin_out(calls, static_cast<std::size_t>(spec.quick_methods));
  const std::vector<VerificationPart> parts = parts_of(spec.settings.parts);
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
         .known = {{"method", call}}});
  }
}

}  // namespace

StudyKind verify_kind() {
  return declared_kind<Spec>(
      {.name = "verify",
       .title = "Verification",
       .description =
           "claimed properties of schemes against their coefficients and their running code: orders, "
           "stability, symplecticity, conservation, step control, agreement with an oracle",
       .summary = columns_of<Row>(),
       .verdict_meaning = "`holds`: nothing fails, and something could be checked; `fails`: a property fails",
       .reason_meaning = "the properties that fail, with what was claimed, derived and measured"},
      plan_verify);
}

}  // namespace fw::study
