#include "catalog/method_call.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::catalog {

MethodCall parse_method_call(const std::string& text) {
  const auto open = text.find('[');
  if (open == std::string::npos) return {text, {}};
  const auto malformed = [&](const std::string& what) {
    throw InputError(
        fmt::format("method \"{}\": {}; expected name or name[option=value,option=value]", text, what));
  };
  if (text.back() != ']') malformed("found no closing ]");
  MethodCall call{text.substr(0, open), {}};
  std::string rest = text.substr(open + 1, text.size() - open - 2);
  if (rest.empty()) malformed("found [] without an option");
  for (bool more = true; more;) {
    const auto comma = rest.find(',');
    const std::string item = rest.substr(0, comma);
    more = comma != std::string::npos;
    if (more) rest = rest.substr(comma + 1);
    const auto equals = item.find('=');
    if (equals == std::string::npos || equals == 0)
      malformed(fmt::format("found \"{}\" without option=value", item));
    if (equals + 1 == item.size())
      malformed(fmt::format("found option \"{}\" without a value", item.substr(0, equals)));
    if (!call.options.emplace(item.substr(0, equals), item.substr(equals + 1)).second) {
      malformed(fmt::format("found option \"{}\" twice", item.substr(0, equals)));
    }
  }
  return call;
}

}  // namespace fw::catalog
