// The subcommands of `tessera`, one file each. Each only parses its arguments, calls the libraries
// and prints.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/status.h"

namespace CLI {
class App;
}

namespace tessera {

class Window;

inline constexpr int kExitDone = 0;
// Bad input or arguments; one line on stderr gives the reason.
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitMostlyLost = 3;  // fewer than half of the frames tracked

// Shared between the commands and main, or the window that calls a command (start_window.h).
struct CommandContext {
    std::vector<std::string> arguments = {};  // the whole command line
    int exit_code = kExitDone;                // set by the command that ran
    std::string error = {};                   // why it failed; empty: it did not
    // The window to go on in; null: a command opens its own.
    std::shared_ptr<Window> window = {};
    // While a run opens its source: called again and again, on the main thread. False: the window
    // was closed. May be empty.
    std::function<bool()> while_opening = {};

    // Sets error and exit code; prints the error.
    void Finish(const Status& status, int code = kExitDone);
};

// Each function adds its subcommand to `app`. A parsed subcommand runs immediately and stores its
// exit code. The context must outlive the parsing.
void AddCalibrateCommand(CLI::App& app, CommandContext& context);
void AddConfigCommand(CLI::App& app, CommandContext& context);
void AddDoctorCommand(CLI::App& app, CommandContext& context);
void AddEvalCommand(CLI::App& app, CommandContext& context);
void AddExportCommand(CLI::App& app, CommandContext& context);
void AddFinishCommand(CLI::App& app, CommandContext& context);
void AddHelpCommand(CLI::App& app, CommandContext& context);
void AddInfoCommand(CLI::App& app, CommandContext& context);
void AddInspectCommand(CLI::App& app, CommandContext& context);
void AddMapsCommand(CLI::App& app, CommandContext& context);
void AddObjectsCommand(CLI::App& app, CommandContext& context);
void AddPlanCommand(CLI::App& app, CommandContext& context);
void AddRenderCommand(CLI::App& app, CommandContext& context);
void AddReportCommand(CLI::App& app, CommandContext& context);
void AddRunCommand(CLI::App& app, CommandContext& context);
void AddScanCommand(CLI::App& app, CommandContext& context);
void AddSweepCommand(CLI::App& app, CommandContext& context);
void AddSynthCommand(CLI::App& app, CommandContext& context);
void AddViewCommand(CLI::App& app, CommandContext& context);

// The error for a word that is no command. Names the nearest one, if one is near.
Status UnknownCommand(const CLI::App& app, const std::string& word);
// Prints the error as one line on stderr and returns kExitBadInput.
int Fail(const Status& error);
// Returns kExitDone, or the result of Fail.
int ExitCode(const Status& status);

}  // namespace tessera
