#pragma once

#include <string>

namespace fw::app {

/// Every method as Markdown, one table per family with its formula: what docs/methods.md shows between its
/// marks. Orders and stability are those derived from the coefficients where there are any.
std::string methods_page();

}  // namespace fw::app
