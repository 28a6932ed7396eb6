// Chooses on the start screen with the mouse and the keyboard, and checks the command line.
#include "viz/start_screen.h"

#include <X11/keysym.h>

#include <filesystem>

#include "core/printable.h"
#include "support/temp_folder.h"
#include "viz/driven_window.h"
#include "viz/recent_paths.h"

namespace tessera {
namespace {

using Words = std::vector<std::string>;
namespace fs = std::filesystem;

class Start : public testing_support::DrivenWindow {
  protected:
    void SetUp() override {
        DrivenWindow::SetUp();
        if (!display_) return;
        before_ = fs::current_path();
        fs::current_path(folder_.path());
        fs::create_directories("data/inside");
        fs::create_directory("rec");
    }
    void TearDown() override {
        screen_.reset();
        if (!before_.empty()) fs::current_path(before_);
    }
    // Knows a recording "rec", a finished "done" and a scan "both".
    static PathFinding Examine(const std::string& path) {
        const std::string name = fs::path(path).filename();
        if (name == "rec") return {true, false, false, "a recording"};
        if (name == "done") return {false, true, false, "finished"};
        if (name == "both") return {true, true, false, "a scan"};
        return {false, false, true, path + ": no such folder"};
    }
    void Open() {
        StartServices services;
        services.examine = Examine;
        services.list_cameras = [this] {
            ++listed_;
            OpenniListing listing;
            listing.built_in = true;
            if (camera_plugged_in_) listing.devices = {{"usb/1", "Xtion", "Asus"}};
            if (!camera_plugged_in_) listing.advice = {"no depth camera: plug one in"};
            return listing;
        };
        services.models = {"models/a.onnx", "models/b.onnx"};
        services.recent_file = folder_ / "recent";
        auto screen = StartScreen::Open(std::move(services), {.wait_s = 0, .double_click_s = 1e3});
        ASSERT_TRUE(screen.ok()) << screen.message();
        screen_ = std::move(screen.value());
        Rounds(5);
    }
    bool RunOnce() override {
        decided_ = !screen_->RunOnce() || decided_;
        return true;
    }
    std::optional<ControlRect> FindControl(const std::string& name) const override {
        return screen_->FindControl(name);
    }
    void Type(const std::string& name, const std::string& text) {
        Click(name);
        for (const char c : text) Key(static_cast<unsigned char>(c));
    }
    // The button can be pressed: it is named so by the command that it does.
    bool Ready(const std::string& button) const {
        return FindControl(button == "start" ? "command.run" : "command.view").has_value();
    }
    // The words without the folder of the results, which has the time in its name.
    Words Decision() {
        EXPECT_TRUE(decided_);
        Words words = decided_ ? screen_->Run() : Words();
        if (words.size() > 4 && words[3] == "--out") words[4] = "OUT";
        return words;
    }

    TempFolder folder_;
    fs::path before_;
    std::atomic<bool> camera_plugged_in_{true};
    std::atomic<int> listed_{0};
    bool decided_ = false;
    std::unique_ptr<StartScreen> screen_;
};

TEST_F(Start, ARecordingIsChosenFromTheListAndStarted) {
    Open();
    Click("start");  // nothing is chosen yet
    EXPECT_FALSE(decided_);
    Click("entry.rec");
    EXPECT_TRUE(Within(20, [&] { return Ready("start"); }));
    Click("start");
    EXPECT_EQ(Decision(), (Words{"tessera", "run", "rec", "--out", "OUT", "--view"}));
    EXPECT_EQ(ReadRecentPaths(folder_ / "recent").at(0), fs::absolute("rec").string());
}

TEST_F(Start, AFinishedScanIsTypedAndOpened) {
    Open();
    Type("path", "done");
    EXPECT_EQ(screen_->choices().path, "done");
    EXPECT_TRUE(Within(20, [&] { return Ready("open"); }));
    EXPECT_FALSE(FindControl("quality.fast"));  // it is only shown
    Click("start");
    EXPECT_FALSE(decided_);
    Click("open");
    EXPECT_EQ(Decision(), (Words{"tessera", "view", "done"}));
}

TEST_F(Start, EnterStartsAndEscapeCloses) {
    Open();
    Click("page.demo");
    Key(XK_Return);
    EXPECT_EQ(Decision(), (Words{"tessera", "run", "synthetic:desk", "--out", "OUT", "--view"}));
    decided_ = false;
    screen_.reset();
    Open();
    MoveTo("page.demo");
    Key(XK_Escape);
    ASSERT_TRUE(decided_);
    EXPECT_TRUE(screen_->Run().empty());
}

// A list that is open gets the keys, and Escape closes it, not the program.
TEST_F(Start, KeysInAListAreNotTheWindows) {
    Open();
    Click("page.demo");
    Click("labels");
    ASSERT_TRUE(FindControl("labels.b.onnx"));
    Key(XK_Return);
    Key(XK_Escape);
    EXPECT_FALSE(decided_);
    EXPECT_FALSE(FindControl("labels.b.onnx"));
    Key(XK_Escape);
    EXPECT_TRUE(decided_);
}

TEST_F(Start, SettingsBecomeOptions) {
    Open();
    Click("page.demo");
    Click("scene.room");
    Click("quality.fine");
    Click("loops");
    Click("labels");
    Click("labels.b.onnx");
    Click("start");
    EXPECT_EQ(Decision(),
              (Words{"tessera", "run", "synthetic:room", "--out", "OUT", "--view", "--set",
                     "mapping.voxel_size_m=0.005", "--set", "mapping.truncation_m=0.02",
                     "--loop-closure", "off", "--labels", "models/b.onnx"}));
}

TEST_F(Start, TheResultsGoWhereTheyAreSent) {
    Open();
    Click("page.demo");
    Type("output", "x");  // at the end of the name that is there
    EXPECT_TRUE(screen_->choices().output_folder.ends_with("x"));
    Click("start");
    ASSERT_TRUE(decided_);
    EXPECT_EQ(screen_->Run().at(4), screen_->choices().output_folder);
}

TEST_F(Start, ErrorsStayOnTheScreen) {
    Open();
    Type("path", "nowhere");
    EXPECT_TRUE(Within(20, [&] { return FindControl("start.error").has_value(); }));
    Click("start");
    Click("open");
    EXPECT_FALSE(decided_);
    // What is refused when it begins is said, too, until something else is chosen.
    Click("page.demo");
    EXPECT_FALSE(FindControl("start.error"));
    Click("start");
    EXPECT_TRUE(decided_);
    EXPECT_TRUE(screen_->Wait());
    EXPECT_TRUE(FindControl("start.opening"));
    screen_->Refuse("camera.yaml: fx is missing");
    Rounds(3);
    EXPECT_TRUE(FindControl("start.error"));
    decided_ = false;
    Click("scene.room");
    EXPECT_FALSE(FindControl("start.error"));
    EXPECT_FALSE(decided_);
}

TEST_F(Start, CamerasAreListedAndListedAgain) {
    camera_plugged_in_ = false;
    Open();
    EXPECT_EQ(listed_, 0);  // asking takes up to a second: only when it is of interest
    Click("page.camera");
    EXPECT_TRUE(Within(20, [&] { return FindControl("cameras.none").has_value(); }));
    Click("start");
    EXPECT_FALSE(decided_);
    camera_plugged_in_ = true;
    Click("cameras.refresh");
    EXPECT_TRUE(Within(20, [&] { return FindControl("camera.usb/1").has_value(); }));
    EXPECT_EQ(listed_, 2);
    Click("start");
    EXPECT_EQ(Decision(), (Words{"tessera", "run", "openni2:usb/1", "--out", "OUT", "--view"}));
}

TEST_F(Start, FoldersAreEnteredAndLeft) {
    Open();
    MoveTo("entry.data");
    for (int i = 0; i < 2; ++i) {
        display_->Press(1);
        Rounds(1);
        display_->Release(1);
        Rounds(1);
    }
    Rounds(4);
    ASSERT_TRUE(FindControl("entry.inside"));
    EXPECT_FALSE(FindControl("entry.rec"));
    Click("entry.inside");
    EXPECT_EQ(screen_->choices().path, "data/inside");
    Click("folder.up");
    EXPECT_TRUE(FindControl("entry.rec"));
}

TEST_F(Start, WhatWasOpenedLastCanBeChosenAgain) {
    AddRecentPath(folder_ / "recent", folder_ / "gone");
    AddRecentPath(folder_ / "recent", folder_ / "rec");
    Open();
    EXPECT_FALSE(FindControl("recent.1"));  // "gone" does not exist
    Click("recent.0");
    EXPECT_EQ(screen_->choices().path, folder_ / "rec");
}

// The clipboard is tried by pasting into the path.
TEST_F(Start, TheCommandLineCanBeCopied) {
    Open();
    Click("page.demo");
    Click("command.copy");
    Click("page.files");
    Click("path");
    for (const unsigned long key : {XK_Control_L, XK_v}) display_->PressKey(key), Rounds(2);
    for (const unsigned long key : {XK_v, XK_Control_L}) display_->ReleaseKey(key), Rounds(2);
    EXPECT_EQ(screen_->choices().path,
              "tessera run synthetic:desk --out " + screen_->choices().output_folder + " --view");
}

}  // namespace
}  // namespace tessera
