#include "viz/start_state.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <filesystem>

#include "viz/recent_paths.h"

namespace tessera {
namespace {

template <std::size_t N>
void Put(const std::string& text, std::array<char, N>& into) {
    const std::size_t size = std::min(text.size(), N - 1);
    std::copy_n(text.begin(), size, into.begin());
    into[size] = 0;
}

std::vector<std::string> ThatExist(std::vector<std::string> paths) {
    std::erase_if(paths, [](const std::string& path) {
        std::error_code ignored;
        return !std::filesystem::exists(path, ignored);
    });
    return paths;
}

}  // namespace

StartState::StartState(StartServices given)
    : services(std::move(given)),
      recent_(ThatExist(ReadRecentPaths(services.recent_file))),
      examiner_(1,
                [this](std::string& path) {
                    findings_.Push({path, services.examine(path)});
                }),
      lister_(1, [this](char&) { listings_.Push(services.list_cameras()); }) {
    choices.output_folder = NewOutputFolder();
    Put(choices.output_folder, typed_output);
    EnterFolder(folder_);
}

bool StartState::Update() {
    bool any = false;
    while (findings_.TryPop(examined_)) any = true;
    OpenniListing listing;
    while (listings_.TryPop(listing)) {
        cameras_ = std::move(listing);
        any = true;
    }
    if (any && cameras_) {
        const auto& devices = cameras_->devices;
        if (std::ranges::find(devices, choices.camera, &OpenniDevice::uri) == devices.end())
            choices.camera = devices.empty() ? "" : devices.front().uri;
    }
    return any;
}

void StartState::Choose(const std::string& path) {
    choices.path = path;
    if (path != typed_path.data()) Put(path, typed_path);
    const std::string source = SourceOf(choices);
    // Not if it is known or being found out already. What is wrong may have been put right.
    if (!source.empty() && (source != asked_ || examined_.finding.failed))
        examiner_.PushNewest(std::string(asked_ = source));
    Changed();
}

void StartState::EnterFolder(const std::string& folder) {
    folder_ = folder;
    list_ = ListFolder(folder);
}

void StartState::RefreshCameras() {
    cameras_asked_ = true;
    cameras_.reset();
    lister_.PushNewest(0);
}

void StartState::ShowPage(StartPage page) {
    choices.page = page;
    if (page == StartPage::kCamera && !cameras_asked_) RefreshCameras();
    Changed();
}

void StartState::Changed() {
    error.clear();
    choices.output_folder = typed_output.data();
    const std::string folder = OutputFolderOf(choices);
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::path(folder) / "run.json", ignored))
        earlier_run_ = EarlierRun::kNone;
    else
        earlier_run_ = services.keeps_run && services.keeps_run(folder) ? EarlierRun::kKept
                                                                        : EarlierRun::kReplaced;
}

PathFinding StartState::finding() const {
    PathFinding found;
    switch (choices.page) {
        case StartPage::kDemo:
            found.can_run = true;
            found.text = "A built-in scene, with a known path and surface. Needs no camera.";
            return found;
        case StartPage::kCamera:
            found.can_run = !choices.camera.empty();
            found.text = !found.can_run ? "Choose a camera."
                                        : "A live camera: the scan begins at once, and is saved "
                                          "when the window is closed.";
            return found;
        case StartPage::kFiles: break;
    }
    if (choices.path.empty())
        found.text = "Choose a recording to scan, or a finished scan to look at.";
    else if (SourceOf(choices) == examined_.path)
        return examined_.finding;
    else
        found.text = "Looking ...";
    return found;
}

void StartState::Start() {
    if (!can_start()) return;
    if (choices.output_folder.empty()) {
        error = "Name a folder for the results.";
        return;
    }
    decision = RunWords(choices);
    AddRecentPath(services.recent_file, OutputFolderOf(choices));
    if (choices.page == StartPage::kFiles) AddRecentPath(services.recent_file, SourceOf(choices));
}

void StartState::Open() {
    if (!can_open()) return;
    decision = ViewWords(choices);
    AddRecentPath(services.recent_file, SourceOf(choices));
}

std::vector<std::string> StartState::Words() const {
    const PathFinding found = finding();
    if (found.can_run) return RunWords(choices);
    return found.can_view ? ViewWords(choices) : std::vector<std::string>();
}

void StartState::OnKey(int key) {
    if (key == GLFW_KEY_ESCAPE) close = true;
    if (key != GLFW_KEY_ENTER && key != GLFW_KEY_KP_ENTER) return;
    if (can_start())
        Start();
    else
        Open();
}

}  // namespace tessera
