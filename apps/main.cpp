// Entry point: parses the command line, runs one command, returns its exit code.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "command.h"

namespace tessera {

int Fail(const Status& error) {
    std::string line = error.message();
    std::replace(line.begin(), line.end(), '\n', ' ');
    fmt::print(stderr, "tessera: {}\n", line);
    return kExitBadInput;
}

int ExitCode(const Status& status) { return status.ok() ? kExitDone : Fail(status); }

void CommandContext::Finish(const Status& status, int code) {
    error = status.message();
    exit_code = status.ok() ? code : Fail(status);
}

namespace {

int ReportParseError(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    // CLI11 only reports that a subcommand is missing.
    if (app.get_subcommands().empty() && !app.remaining().empty())
        return Fail(UnknownCommand(app, app.remaining().front()));
    if (app.get_subcommands().empty() && error.get_name() == "RequiredError") {
        fmt::print(stderr, "{}", app.help());
        return kExitBadInput;
    }
    std::string command = "tessera";
    for (const CLI::App* used = &app; !used->get_subcommands().empty();) {
        used = used->get_subcommands().front();
        command += " " + used->get_name();
    }
    return Fail(Status::Error(fmt::format("{} (see {} -h)", error.what(), command)));
}

constexpr const char* kOutOfMemory =
    "out of memory; what was written so far is kept, and a scan can be continued with --resume. "
    "Use larger voxels (mapping.voxel_size_m) or a limit (mapping.memory_limit_mb with --scan)";

// An exception that leaves a thread. None but std::bad_alloc does, unless there is a bug.
[[noreturn]] void EndUncaught() {
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "tessera: %s\n", kOutOfMemory);
        std::_Exit(kExitBadInput);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tessera: %s\n", error.what());
    } catch (...) {
    }
    std::abort();
}

int Main(int argc, char** argv) {
    std::set_terminate(EndUncaught);
    spdlog::set_default_logger(spdlog::stderr_color_mt("tessera"));
    spdlog::set_pattern("%^%l%$: %v");
    // A file that cannot grow is a write error, not the end of the program.
    std::signal(SIGXFSZ, SIG_IGN);

    CLI::App app(
        "Tessera: dense RGB-D SLAM. Exit codes: 0 done; 2 bad input or arguments; 3 fewer than "
        "half of the "
        "frames tracked.",
        "tessera");
    app.set_version_flag("--version", std::string("tessera ") + TESSERA_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    CommandContext context{.arguments = {argv, argv + argc}};
    AddRunCommand(app, context);
    AddEvalCommand(app, context);
    AddSynthCommand(app, context);
    AddSweepCommand(app, context);
    AddInspectCommand(app, context);
    AddPlanCommand(app, context);
    AddRenderCommand(app, context);
    AddReportCommand(app, context);
    AddMapsCommand(app, context);
    AddObjectsCommand(app, context);
    AddViewCommand(app, context);
    AddExportCommand(app, context);
    AddFinishCommand(app, context);
    AddScanCommand(app, context);
    AddInfoCommand(app, context);
    AddDoctorCommand(app, context);
    AddCalibrateCommand(app, context);
    AddConfigCommand(app, context);
    AddHelpCommand(app, context);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return ReportParseError(app, error);
    }
    return context.exit_code;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    try {
        return tessera::Main(argc, argv);
    } catch (const std::bad_alloc&) {
        return tessera::Fail(tessera::Status::Error(tessera::kOutOfMemory));
    } catch (const std::exception& error) {
        return tessera::Fail(tessera::Status::Error(error.what()));
    }
}
