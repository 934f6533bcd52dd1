#include "study/shared_problem.hpp"

#include "analysis/reference/binary64_reference.hpp"
#include "analysis/reference/reference_cache.hpp"

namespace fw::study {

std::string to_string(ReferenceArithmetic arithmetic) {
  return arithmetic == ReferenceArithmetic::binary128 ? "binary128" : "binary64";
}

settings::Setting reference_setting(ReferenceArithmetic& arithmetic) {
  return settings::choice(
      "reference", arithmetic,
      {{"binary128", ReferenceArithmetic::binary128}, {"binary64", ReferenceArithmetic::binary64}});
}

settings::Setting reference_setting(std::optional<ReferenceArithmetic>& arithmetic) {
  return settings::choice(
             "reference", arithmetic,
             {{"binary128", ReferenceArithmetic::binary128}, {"binary64", ReferenceArithmetic::binary64}})
      .default_text("`\"binary128\"`");
}

const analysis::ReferenceSolution& SharedProblem::reference(const RunContext& context) const {
  std::call_once(once_, [&] {
    const double end[] = {ivp().t1};
    if (problem_.problem.exact) {
      reference_ = analysis::reference(problem_.problem, end);
    } else if (arithmetic_ == ReferenceArithmetic::binary128) {
      analysis::ReferenceOptions options;
      options.progress = [&context](double fraction) {
        context.check();
        if (context.tell) context.tell({.what = "reference in binary128", .fraction = fraction});
      };
      reference_ =
          analysis::ReferenceCache(context.reference_cache).certified(problem_.identity, ivp(), end, options);
    } else {
      reference_ = analysis::binary64_reference(ivp(), context.stop);
      if (reference_.status.code == StatusCode::interrupted) context.check();  // the next call tries again
    }
  });
  return reference_;
}

}  // namespace fw::study
