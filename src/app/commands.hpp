#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace fw::app {

/// Exit codes of the shell command.
inline constexpr int exit_success = 0;        ///< done, all verdicts hold
inline constexpr int exit_verdict_fails = 1;  ///< done, but a verdict fails
inline constexpr int exit_bad_input = 2;      ///< bad usage or input, nothing written
inline constexpr int exit_failure = 3;        ///< numerical or system failure, what was finished is kept

/// Refuses an option's text that is no integer of 64 bits, with the text as it was given: CLI11 takes the nearest one.
CLI::Validator whole_number();

/// What a subcommand does after parsing; returns the exit code.
using Action = std::function<int()>;

/// Each adds its subcommand to `app` and sets `action` when it was chosen. `command_line` is what the user
/// typed.
void add_list_command(CLI::App& app, Action& action);
void add_describe_command(CLI::App& app, Action& action);
void add_simulate_command(CLI::App& app, Action& action, const std::string& command_line);
void add_run_command(CLI::App& app, Action& action, const std::string& command_line);
void add_verify_command(CLI::App& app, Action& action, const std::string& command_line);
void add_show_command(CLI::App& app, Action& action);
void add_schema_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_equilibrium_command(CLI::App& app, Action& action, const std::string& command_line);

}  // namespace fw::app
