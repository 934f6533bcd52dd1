#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <system_error>

#include "app/commands.hpp"
#include "core/error.hpp"
#include "system/provenance.hpp"
#include "text/closest_name.hpp"
#include "text/utf8.hpp"

namespace {

/// What the user typed, with quotes where the shell needs them.
std::string join_arguments(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    if (!text.empty()) text += ' ';
    const bool needs_quotes =
        argument.empty() || argument.find_first_of(" \t'\"$`\\[]*?&;|<>()") != std::string::npos;
    if (!needs_quotes) {
      text += argument;
      continue;
    }
    text += '\'';
    for (char letter : argument) text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    text += '\'';
  }
  return text;
}

/// One line on standard error, whatever names and messages contain.
void report(const std::string& message) {
  fmt::print(stderr, "federwerk: {}\n", fw::text::printable_line(message));
}

/// "federwerk simulate" if that subcommand was named, else "federwerk".
std::string chosen_command(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app.get_name() : app.get_name() + " " + chosen.front()->get_name();
}

/// Throws InputError if no subcommand was named, or something else in its place.
void check_subcommand(const CLI::App& app) {
  const std::vector<std::string> extras = app.remaining();
  if (!extras.empty()) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    throw fw::InputError(fmt::format("unknown {} \"{}\"{}; \"federwerk --help\" shows the usage",
                                     extras.front().starts_with('-') ? "option" : "subcommand",
                                     extras.front(), fw::did_you_mean(extras.front(), names)));
  }
  if (app.get_subcommands().empty()) {
    throw fw::InputError("a subcommand is required; \"federwerk --help\" shows the usage");
  }
}

int run(int argc, char** argv) {
  CLI::App app{"federwerk: a laboratory for the numerics of mass-spring systems", "federwerk"};
  app.set_version_flag("--version", fw::version());
  fw::app::Action action;
  const std::string command_line = join_arguments(argc, argv);
  fw::app::add_list_command(app, action);
  fw::app::add_describe_command(app, action);
  fw::app::add_simulate_command(app, action, command_line);
  fw::app::add_run_command(app, action, command_line);
  fw::app::add_verify_command(app, action, command_line);
  fw::app::add_show_command(app, action);
  fw::app::add_schema_command(app, action);
  fw::app::add_check_command(app, action);
  fw::app::add_equilibrium_command(app, action, command_line);
  app.require_subcommand(0, 1);
  app.allow_extras();  // of the top level only, which check_subcommand names more clearly
  try {
    app.parse(argc, argv);
    check_subcommand(app);
  } catch (const CLI::Success& help) {  // --help, --version
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    report(fmt::format("{}; \"{} --help\" shows the usage", error.what(), chosen_command(app)));
    return fw::app::exit_bad_input;
  }
  int code = fw::app::exit_success;
  try {
    code = action();
  } catch (const std::filesystem::filesystem_error&) {
    throw;  // names its file
  } catch (const std::system_error&
               error) {  // a table that does not fit the buffer is written, and fails, at once
    throw fw::SystemError(
        fmt::format("cannot write to standard output: {}", std::strerror(error.code().value())));
  }
  // What is buffered fails only here, and a table that was cut off must not pass for a whole one.
  if (std::fflush(stdout) != 0) {
    throw fw::SystemError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const fw::InputError& error) {
    report(error.what());
    return fw::app::exit_bad_input;
  } catch (const std::bad_alloc&) {
    report("out of memory");
    return fw::app::exit_failure;
  } catch (const std::exception& error) {
    report(error.what());
    return fw::app::exit_failure;
  }
}
