// Scans and looks at scans from the start screen of `tessera view`, with mouse and keyboard.
#include <X11/keysym.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "support/temp_folder.h"
#include "viz/start_screen.h"
#include "viz/virtual_display.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

std::string TextOf(const fs::path& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

// Runs the program in a folder of its own. The places of its controls are those of a start screen
// in this process, in the same folder.
class StartProgram : public testing::Test {
  protected:
    void SetUp() override {
        std::string why;
        display_ = testing_support::VirtualDisplay::Start(why);
        if (!display_) GTEST_SKIP() << why;
        setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
        before_ = fs::current_path();
        fs::current_path(folder_.path());
        const std::string synth =
            std::string(TESSERA_PROGRAM) + " synth corner --frames 4 --out rec >/dev/null 2>&1";
        ASSERT_EQ(std::system(synth.c_str()), 0);
        fs::create_directory("done");
        TriangleMesh mesh;
        mesh.vertices = {{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}};
        mesh.triangles = {{0, 2, 1}};
        ASSERT_TRUE(WritePly("done/mesh.ply", mesh).ok());
        LearnPlaces();
        Launch();
    }
    void TearDown() override {
        if (program_ > 0) {
            kill(program_, SIGKILL);
            waitpid(program_, nullptr, 0);
        }
        if (!before_.empty()) fs::current_path(before_);
    }
    void LearnPlaces() {
        auto screen =
            StartScreen::Open({.examine = [](const std::string&) { return PathFinding{}; },
                               .list_cameras = [] { return OpenniListing{}; },
                               .models = {},
                               .recent_file = {}},
                              {.wait_s = 0});
        ASSERT_TRUE(screen.ok()) << screen.message();
        for (int i = 0; i < 5; ++i) screen.value()->RunOnce();
        for (const char* name : {"entry.rec", "entry.done", "path", "start", "open", "output"}) {
            const auto rect = screen.value()->FindControl(name);
            ASSERT_TRUE(rect) << name;
            places_[name] = *rect;
        }
    }
    void Launch() {
        program_ = fork();
        if (program_ == 0) {
            (void)!freopen("stderr", "w", stderr);
            (void)!freopen("stdout", "w", stdout);
            execl(TESSERA_PROGRAM, "tessera", "view", nullptr);
            _exit(127);
        }
        ASSERT_TRUE(Within(30, [&] { return display_->HasWindow("Tessera"); }));
        Pause();
    }
    // Waits until the condition holds, at most so many seconds.
    static bool Within(double seconds, const std::function<bool()>& condition) {
        for (double waited = 0; !condition(); waited += 0.02) {
            if (waited > seconds) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return true;
    }
    static void Pause() { std::this_thread::sleep_for(std::chrono::milliseconds(400)); }
    void Click(const std::string& name) {
        const ControlRect& rect = places_.at(name);
        display_->MoveTo(rect.x + rect.width / 2, rect.y + rect.height / 2);
        Pause();
        display_->Press(1);
        Pause();
        display_->Release(1);
        Pause();
    }
    void Key(unsigned long keysym) {
        display_->PressKey(keysym);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        display_->ReleaseKey(keysym);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    void Type(const std::string& text) {
        for (const char c : text) Key(static_cast<unsigned char>(c));
    }
    // The exit code; -1 if the program goes on.
    int Exit() {
        int status = 0;
        if (!Within(60, [&] { return waitpid(program_, &status, WNOHANG) == program_; })) return -1;
        program_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
    }
    void ShowAndCloseTheFinishedScan() {
        Click("entry.done");
        Click("open");
        ASSERT_TRUE(Within(30, [&] { return display_->HasWindow("done - Tessera"); }))
            << TextOf("stderr");
        ASSERT_TRUE(display_->AskToClose("done - Tessera"));
        EXPECT_EQ(Exit(), 0) << TextOf("stderr");
    }
    // The folder that the run made; empty: none.
    static fs::path Results() {
        for (const auto& entry : fs::directory_iterator("."))
            if (entry.path().filename().string().starts_with("scan-")) return entry.path();
        return {};
    }
    static bool Finished() {
        return TextOf(Results() / "run.json").find("\"finished\"") != std::string::npos;
    }

    TempFolder folder_;
    fs::path before_;
    std::unique_ptr<testing_support::VirtualDisplay> display_;
    std::map<std::string, ControlRect> places_;
    pid_t program_ = -1;
};

TEST_F(StartProgram, ARecordingIsScannedToItsEnd) {
    Click("entry.rec");
    Click("start");
    ASSERT_TRUE(Within(60, [&] { return display_->HasWindow("rec - Tessera"); }))
        << TextOf("stderr");
    EXPECT_FALSE(display_->HasWindow("Tessera"));  // it is the same window
    ASSERT_TRUE(Within(60, Finished)) << TextOf("stderr");
    ASSERT_TRUE(display_->AskToClose("rec - Tessera"));
    EXPECT_EQ(Exit(), 0) << TextOf("stderr");
    EXPECT_TRUE(fs::exists(Results() / "mesh.ply"));
    EXPECT_NE(TextOf("stdout").find("4 frames, 4 tracked"), std::string::npos) << TextOf("stdout");
    // Exactly the command line that stood on the screen.
    const auto run = nlohmann::json::parse(TextOf(Results() / "run.json"));
    std::vector<std::string> words = run["command_line"];
    words.erase(words.begin());
    EXPECT_EQ(words, (std::vector<std::string>{"run", "rec", "--out", Results().filename().string(),
                                               "--view"}));
}

TEST_F(StartProgram, AFinishedScanIsShown) { ShowAndCloseTheFinishedScan(); }

TEST_F(StartProgram, AFinishedScanIsMeasuredAndMadeAModel) {
    fs::remove("done/mesh.ply");  // not of a run, so it would not be replaced
    const std::string run = std::string(TESSERA_PROGRAM) + " run rec --out done >/dev/null 2>&1";
    ASSERT_EQ(std::system(run.c_str()), 0);
    Click("entry.done");
    Click("open");
    ASSERT_TRUE(Within(30, [&] { return display_->HasWindow("done - Tessera"); }))
        << TextOf("stderr");
    Pause();
    places_["left"] = {600, 300, 0, 0};  // on the surface
    places_["right"] = {680, 330, 0, 0};
    display_->MoveTo(600, 300);
    Key(XK_l);
    Click("left");
    Click("right");
    EXPECT_TRUE(Within(20, [] { return fs::exists("done/measurements.json"); }));
    const auto kept = nlohmann::json::parse(TextOf("done/measurements.json"), nullptr, false);
    EXPECT_GT(kept["measurements"][0]["length_m"], 0.01);
    Key(XK_g);
    EXPECT_TRUE(Within(60, [] { return fs::exists("done/model/filled.ply"); }));
    EXPECT_TRUE(fs::exists("done/model/model.glb"));
    ASSERT_TRUE(display_->AskToClose("done - Tessera"));
    EXPECT_EQ(Exit(), 0) << TextOf("stderr");
}

// Finishing again, and pictures, replace nothing and are in the folder of the run.
TEST_F(StartProgram, AModelThatIsThereIsKept) {
    fs::remove("done/mesh.ply");  // not of a run, so it would not be replaced
    const std::string run = std::string(TESSERA_PROGRAM) + " run rec --out done >/dev/null 2>&1";
    ASSERT_EQ(std::system(run.c_str()), 0);
    fs::create_directories("done/model");
    std::ofstream("done/model/model.glb") << "cleaned by hand";
    Click("entry.done");
    Click("open");
    ASSERT_TRUE(Within(30, [&] { return display_->HasWindow("done - Tessera"); }))
        << TextOf("stderr");
    Pause();
    display_->MoveTo(600, 300);
    Key(XK_g);
    EXPECT_TRUE(Within(60, [] { return fs::exists("done/model_2/filled.ply"); }));
    EXPECT_EQ(TextOf("done/model/model.glb"), "cleaned by hand");
    Key(XK_p);
    EXPECT_TRUE(Within(20, [] {
        return std::ranges::any_of(fs::directory_iterator("done"), [](const auto& entry) {
            return entry.path().filename().string().starts_with("scan-");
        });
    }));
    ASSERT_TRUE(display_->AskToClose("done - Tessera"));
    EXPECT_EQ(Exit(), 0) << TextOf("stderr");
}

// What is refused when the run begins is said on the screen, and another choice can be made.
TEST_F(StartProgram, AfterAnErrorTheScreenStays) {
    Click("output");
    display_->PressKey(XK_Control_L);
    Key(XK_a);
    display_->ReleaseKey(XK_Control_L);
    Type("/proc/no");
    Click("entry.rec");
    Click("start");
    ASSERT_TRUE(Within(60, [] { return TextOf("stderr").find("/proc/no") != std::string::npos; }));
    Pause();
    ASSERT_TRUE(display_->HasWindow("Tessera"));
    ShowAndCloseTheFinishedScan();
}

TEST_F(StartProgram, ClosedWithoutAChoiceNothingIsDone) {
    ASSERT_TRUE(display_->AskToClose("Tessera"));
    EXPECT_EQ(Exit(), 0) << TextOf("stderr");
    EXPECT_TRUE(Results().empty());
    EXPECT_EQ(TextOf("stderr"), "");
}

}  // namespace
}  // namespace tessera
