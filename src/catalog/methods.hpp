#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "catalog/method_call.hpp"
#include "ode/integrator.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::catalog {

/// One line of the list of methods.
class MethodEntry {
 public:
  using Make = std::function<std::unique_ptr<Integrator>(const MethodOptions&)>;

  MethodEntry(std::string method_name, std::vector<OptionInfo> method_options,
              schemes::SchemeData scheme_data, Make make_method)
      : name(std::move(method_name)),
        options(std::move(method_options)),
        data(std::move(scheme_data)),
        make(std::move(make_method)),
        lazy_(std::make_shared<Lazy>()) {}

  /// What is known of the method with its default options. Derived when it is first asked for, since the
  /// order conditions of a hundred schemes would delay every start of the program.
  const MethodInfo& info() const {
    std::call_once(lazy_->once, [&] { lazy_->info = make({})->info(); });
    return lazy_->info;
  }

  std::string name;
  std::vector<OptionInfo> options;
  schemes::SchemeData data;  ///< the coefficients that define it, if it is defined so
  /// Makes the integrator. Throws InputError for a bad option value; unknown options are checked before.
  Make make;

 private:
  struct Lazy {
    std::once_flag once;
    MethodInfo info;
  };
  std::shared_ptr<Lazy> lazy_;
};

/// A method without options.
inline MethodEntry plain(std::function<std::unique_ptr<Integrator>()> make) {
  return {make()->info().name, {}, {}, [make = std::move(make)](const MethodOptions&) { return make(); }};
}

/// Every method, hand-written ones first, then the oracles. The only place where one is registered.
const std::vector<MethodEntry>& methods();

/// The entry of that name; throws InputError with the nearest name.
const MethodEntry& find_method(const std::string& name);

/// The integrator of a call such as "rk4" or "implicit_euler_linearised[linear_solver=cholesky]".
std::unique_ptr<Integrator> make_method(const std::string& call);
std::unique_ptr<Integrator> make_method(const MethodCall& call);

/// The coefficients behind a call; std::monostate where there are none, or where an option may change the
/// scheme (those of a step size controller do not).
schemes::SchemeData scheme_of(const std::string& call);

}  // namespace fw::catalog
