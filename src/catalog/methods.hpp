#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/theory/method_theory.hpp"
#include "catalog/method_call.hpp"
#include "ode/integrator.hpp"
#include "settings/description.hpp"

namespace fw::catalog {

/// What theory says of a method with the options of a call; an empty function: nothing.
using TheoryOfOptions = std::function<analysis::Theory(const MethodOptions&)>;

/// One line of the list of methods: its code and its theory, both made with the options of a call.
class MethodEntry {
 public:
  using Make = std::function<std::unique_ptr<Integrator>(const MethodOptions&)>;

  MethodEntry(std::string method_name, std::vector<settings::SettingDescription> method_options,
              TheoryOfOptions method_theory, Make make_method)
      : name(std::move(method_name)),
        options(std::move(method_options)),
        make(std::move(make_method)),
        theory_(std::move(method_theory)),
        lazy_(std::make_shared<Lazy>()) {}

  /// What is known of the method with its default options. Derived when it is first asked for, since the
  /// order conditions of a hundred schemes would delay every start of the program.
  const MethodInfo& info() const {
    std::call_once(lazy_->once, [&] { lazy_->info = make({})->info(); });
    return lazy_->info;
  }

  /// What theory says of it with these options. Throws InputError for a bad option value.
  analysis::Theory theory(const MethodOptions& given) const {
    return theory_ ? theory_(given) : analysis::Theory{};
  }

  std::string name;
  std::vector<settings::SettingDescription> options;  ///< type, range, default and meaning
  /// Makes the integrator. Throws InputError for a bad option value; unknown options are checked before.
  Make make;

 private:
  struct Lazy {
    std::once_flag once;
    MethodInfo info;
  };
  TheoryOfOptions theory_;
  std::shared_ptr<Lazy> lazy_;
};

/// A method without options.
inline MethodEntry plain(std::function<std::unique_ptr<Integrator>()> make, analysis::Theory theory = {}) {
  return {make()->info().name,
          {},
          [theory = std::move(theory)](const MethodOptions&) { return theory; },
          [make = std::move(make)](const MethodOptions&) { return make(); }};
}

/// The theory of a method that is its coefficients, whatever its options; the data outlive the list.
template <class Data>
TheoryOfOptions of_coefficients(const Data& data) {
  return [&data](const MethodOptions&) { return analysis::theory_of(data); };
}

/// The coefficients of that name in a list, for the theory of a method that coincides with it. Throws
/// std::logic_error where there is none.
template <class Data>
const Data& named(const std::vector<Data>& list, std::string_view name) {
  for (const Data& data : list) {
    if (data.name == name) return data;
  }
  throw std::logic_error(fmt::format("no coefficients are called \"{}\"", name));
}

/// Every method, hand-written ones first, then the oracles. The only place where one is registered.
const std::vector<MethodEntry>& methods();

/// The methods to start with, as calls: those of the lecture and one good choice of each kind.
const std::vector<std::string>& first_methods();

/// What a method is called here that other programs and books (MATLAB, SciPy, Hairer's codes, graphics) call `name`;
/// of foreign ones it is the name without its library. Empty: not known.
std::string our_name_of(const std::string& name);

/// The entry of that name; throws InputError with the nearest name.
const MethodEntry& find_method(const std::string& name);

/// The integrator of a call such as "rk4" or "implicit_euler_linearised[linear_solver=cholesky]". Methods that choose
/// their steps take the option `maximum_step` [s] beside their own.
std::unique_ptr<Integrator> make_method(const std::string& call);
std::unique_ptr<Integrator> make_method(const MethodCall& call);

/// What theory says of a call. Throws InputError for an unknown method, option or value.
analysis::Theory theory_of_call(const std::string& call);

}  // namespace fw::catalog
