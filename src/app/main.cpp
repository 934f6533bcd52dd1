#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "app/commands.hpp"
#include "core/error.hpp"
#include "core/provenance.hpp"

namespace {

/// What the user typed, with quotes where the shell needs them.
std::string join_arguments(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    if (!text.empty()) text += ' ';
    const bool needs_quotes =
        argument.empty() || argument.find_first_of(" \t'\"$`\\[]*?&;|<>()") != std::string::npos;
    text += needs_quotes ? "'" + argument + "'" : argument;
  }
  return text;
}

int run(int argc, char** argv) {
  CLI::App app{"federwerk: a laboratory for the numerics of mass-spring systems", "federwerk"};
  app.set_version_flag("--version", fw::version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  fw::app::Action action;
  const std::string command_line = join_arguments(argc, argv);
  fw::app::add_list_command(app, action);
  fw::app::add_describe_command(app, action);
  fw::app::add_simulate_command(app, action, command_line);
  fw::app::add_run_command(app, action, command_line);
  fw::app::add_show_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {  // --help, --version
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return fw::app::exit_bad_input;
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const fw::InputError& error) {
    fmt::print(stderr, "federwerk: {}\n", error.what());
    return fw::app::exit_bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "federwerk: out of memory\n");
    return fw::app::exit_failure;
  } catch (const std::exception& error) {
    fmt::print(stderr, "federwerk: {}\n", error.what());
    return fw::app::exit_failure;
  }
}
