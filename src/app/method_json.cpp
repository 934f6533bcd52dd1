#include "app/method_json.hpp"

namespace fw::app {

void write_method_properties(text::JsonWriter& json, const MethodInfo& info) {
  json.key("order").value(std::int64_t{info.order});
  json.key("order_with_velocity_forces").value(std::int64_t{info.order_with_velocity_forces});
  json.key("stages").value(std::int64_t{info.stages});
  json.key("explicit").value(info.is_explicit).key("multistep").value(info.is_multistep);
  json.key("adaptive").value(info.is_adaptive).key("symplectic").value(info.is_symplectic);
  json.key("dense_output").value(to_string(info.dense_output));
  json.key("a_stable").value(info.is_a_stable).key("l_stable").value(info.is_l_stable);
}

}  // namespace fw::app
