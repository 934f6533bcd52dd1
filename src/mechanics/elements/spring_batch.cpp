#include "mechanics/elements/spring_batch.hpp"

#include "mechanics/elements/element_validation.hpp"

namespace fw::mechanics {

void validate_arrays(const Springs& springs) {
  const auto require_size = [&](std::string_view array, std::size_t size) {
    if (size != springs.size()) {
      throw InputError(fmt::format("springs.{}: found {} entries, expected {} (as many as springs.first)",
                                   array, size, springs.size()));
    }
  };
  require_size("second", springs.second.size());
  require_size("stiffness", springs.stiffness.size());
  require_size("damping", springs.damping.size());
  require_size("rest_length", springs.rest_length.size());
  if (springs.groups.empty()) return;
  std::size_t covered = 0;
  for (const SpringGroup& group : springs.groups) covered += group.size;
  if (covered != springs.size()) {
    throw InputError(
        fmt::format("springs.groups: found {} springs in {} groups, expected {} (as many as "
                    "springs.first)",
                    covered, springs.groups.size(), springs.size()));
  }
}

void validate_springs(const Springs& springs, SpringLaw law, std::size_t begin, std::size_t end,
                      std::size_t particles) {
  for (std::size_t e = begin; e < end; ++e) {
    require_particle("springs.first", e, "", springs.first[e], particles);
    require_particle("springs.second", e, "", springs.second[e], particles);
    if (springs.first[e] == springs.second[e]) {
      refuse("springs.second", e, "", springs.second[e], "a particle other than springs.first");
    }
    require_not_negative("springs.stiffness", e, "", springs.stiffness[e]);
    require_not_negative("springs.damping", e, "", springs.damping[e]);
    require_not_negative("springs.rest_length", e, "", springs.rest_length[e]);
    if (law == SpringLaw::strain && springs.rest_length[e] == 0.0) {
      refuse("springs.rest_length", e, "", 0.0, "a number > 0 under the law \"strain\"");
    }
  }
}

}  // namespace fw::mechanics
