#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "store/show.hpp"

namespace fw::app {

void add_show_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("show", "Prints the tables and verdicts in a result file");
  auto path = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("file", *path, "Result file")->required()->type_name("FILE.h5");
  command->add_flag("--json", *json, "As JSON");
  command->callback([path, json, &action] {
    action = [path, json] {
      fmt::print("{}", *json ? store::show_json(*path) : store::show(*path));
      return exit_success;
    };
  });
}

}  // namespace fw::app
