#include "start_window.h"

#include <CLI/CLI.hpp>

#include "command.h"
#include "io/openni_devices.h"
#include "models_beside.h"
#include "run/earlier_run.h"
#include "run/examine_path.h"
#include "viz/recent_paths.h"
#include "viz/start_screen.h"

namespace tessera {
namespace {

StartServices Services() {
    StartServices services;
    services.examine = [](const std::string& path) {
        const ExaminedPath found = ExaminePath(path, RunConfig());
        return PathFinding{found.can_run, found.can_view, found.failed, found.text};
    };
    services.list_cameras = ListOpenniDevices;
    services.keeps_run = HoldsCameraRun;
    services.models = ModelsBeside("");
    services.recent_file = RecentFile();
    return services;
}

// Does what the words say, with the code that does it on the command line.
void Do(const std::vector<std::string>& words, CommandContext& context) {
    CLI::App app("", words.front());
    AddRunCommand(app, context);
    AddViewCommand(app, context);
    std::vector<std::string> last_first(words.rbegin(), words.rend() - 1);  // as CLI11 takes them
    try {
        app.parse(last_first);
    } catch (const CLI::ParseError& error) {
        context.Finish(Status::Error(error.what()));
    }
}

}  // namespace

int StartInWindow(const CommandContext& context, int width, int height) {
    Result<std::unique_ptr<StartScreen>> opened =
        StartScreen::Open(Services(), {.width = width, .height = height});
    if (!opened.ok()) return Fail(opened.status());
    StartScreen& screen = *opened.value();
    for (int exit_code = kExitDone;;) {
        const std::vector<std::string> words = screen.Run();
        if (words.empty()) return exit_code;
        CommandContext chosen{.arguments = words, .window = screen.window()};
        chosen.arguments.front() = context.arguments.front();
        chosen.while_opening = [&screen] { return screen.Wait(); };
        Do(words, chosen);
        if (chosen.error.empty()) return chosen.exit_code;
        exit_code = chosen.exit_code;
        screen.Refuse(chosen.error);
    }
}

}  // namespace tessera
