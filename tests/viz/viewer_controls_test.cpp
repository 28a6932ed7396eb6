// Clicks the controls that give commands and checks what the system receives.
#include "viz/viewer_controls.h"

#include <X11/keysym.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_io.h"

namespace tessera {
namespace {

using Kind = ViewerCommand::Kind;

TEST_F(ViewerControls, PauseStepAndResume) {
    Frames(2);
    Click("pause");
    EXPECT_EQ(Commands(), std::vector{Kind::kPause});
    const std::int64_t frames = system_->frames();
    Commands();
    EXPECT_EQ(system_->frames(), frames);
    Click("step");
    EXPECT_EQ(Commands(), (std::vector{Kind::kPause, Kind::kStep}));
    Commands();
    EXPECT_EQ(system_->frames(), frames + 1);
    Click("pause");
    EXPECT_EQ(Commands(), (std::vector{Kind::kPause, Kind::kStep, Kind::kResume}));
    Commands();
    EXPECT_EQ(system_->frames(), frames + 3);
}

TEST_F(ViewerControls, ResetIsAskedFor) {
    Frames(3);
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    Click("reset");
    EXPECT_TRUE(Commands().empty());
    Click("reset.cancel");
    EXPECT_TRUE(Commands().empty());
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    Key(XK_r);
    Click("reset.confirm");
    EXPECT_EQ(Commands(), std::vector{Kind::kReset});
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    Click("pause");  // the dialog no longer blocks clicks
    EXPECT_EQ(Commands(), (std::vector{Kind::kReset, Kind::kPause}));
}

TEST_F(ViewerControls, TheMeshIsSaved) {
    Frames(2);
    Click("save_mesh");
    ASSERT_EQ(Commands(), std::vector{Kind::kSaveMesh});
    const std::string path = system_->commands().back().path;
    EXPECT_EQ(std::filesystem::path(path).parent_path(), folder_.path());
    EXPECT_EQ(std::filesystem::path(path).extension(), ".ply");
    const auto mesh = ReadPly(path);
    ASSERT_TRUE(mesh.ok()) << mesh.message();
    EXPECT_GT(mesh.value().triangles.size(), 1000u);
    Click("save_mesh");  // the name differs even within the same second
    Commands();
    EXPECT_NE(system_->commands().back().path, path);
}

TEST_F(ViewerControls, TheScanIsSavedUnderANewName) {
    Frames(2);
    Click("save_scan");
    ASSERT_EQ(Commands(), std::vector{Kind::kSaveScan});
    const std::filesystem::path path = system_->commands().back().path;
    EXPECT_EQ(path.parent_path(), folder_.path());
    EXPECT_EQ(path.extension(), ".scan");
}

TEST_F(ViewerControls, RecordingBeginsAndEnds) {
    Frames(1);
    Click("record");
    EXPECT_EQ(Commands(), std::vector{Kind::kRecord});
    Click("record");
    EXPECT_EQ(Commands(), (std::vector{Kind::kRecord, Kind::kStopRecording}));
    EXPECT_NE(system_->commands()[0].path.find("recording-"), std::string::npos);
}

TEST_F(ViewerControls, KeysDoWhatButtonsDo) {
    Frames(1);
    MoveTo("view");  // without a window manager, keys go to the window under the pointer
    for (const unsigned long key : {XK_space, XK_space, XK_s, XK_m, XK_k, XK_v, XK_v}) {
        Key(key);
        system_->Step();  // the effect of a key may depend on the state of the system
    }
    EXPECT_EQ(Commands(), (std::vector{Kind::kPause, Kind::kResume, Kind::kStep, Kind::kSaveMesh,
                                       Kind::kSaveScan, Kind::kRecord, Kind::kStopRecording}));
    for (const auto& [key, method] :
         {std::pair<unsigned long, TrackingMethod>{XK_2, TrackingMethod::kSdfGeometric},
          {XK_3, TrackingMethod::kIcp},
          {XK_4, TrackingMethod::kIcpRgb},
          {XK_1, TrackingMethod::kSdf}}) {
        Key(key);
        ASSERT_NE(LastSettings(), nullptr);
        EXPECT_EQ(LastSettings()->method, method);
    }
}

TEST_F(ViewerControls, HelpComesAndGoes) {
    MoveTo("view", 0.05f);
    EXPECT_FALSE(viewer_->FindControl("help.panel"));
    Key(XK_h);
    EXPECT_TRUE(viewer_->FindControl("help.panel"));
    Key(XK_Escape);
    EXPECT_FALSE(viewer_->FindControl("help.panel"));
    Click("help");
    EXPECT_TRUE(viewer_->FindControl("help.panel"));
    Click("help.close");
    EXPECT_FALSE(viewer_->FindControl("help.panel"));
}

// No key and no click gets past the question to the run beneath.
TEST_F(ViewerControls, AQuestionHoldsKeyboardAndMouse) {
    Frames(3);
    MoveTo("view");
    Key(XK_r);
    ASSERT_TRUE(viewer_->FindControl("reset.confirm"));
    for (const unsigned long key : {XK_space, XK_m, XK_2, XK_q, XK_Tab}) Key(key);
    for (const char* name : {"pause", "method.icp"}) Click(name);
    EXPECT_TRUE(Commands().empty());
    EXPECT_EQ(LastSettings(), nullptr);
    EXPECT_TRUE(viewer_->FindControl("reset.confirm"));
    EXPECT_TRUE(viewer_->FindControl("method.icp"));  // still the expert view
    Key(XK_Escape);
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    EXPECT_TRUE(Commands().empty());
    Key(XK_space);  // reaches the run again
    EXPECT_EQ(Commands(), std::vector{Kind::kPause});
    Key(XK_r);
    Key(XK_Return);
    EXPECT_EQ(Commands(), (std::vector{Kind::kPause, Kind::kReset}));
}

// The map of an ended run can still be saved, if whoever ran it keeps it.
TEST_F(ViewerControls, SavingIsPossibleAfterTheEnd) {
    Frames(2);
    link_.keeps_map = true;
    link_.ended = true;
    Rounds(4);
    Click("save_mesh");
    Key(XK_k);
    Click("pause");
    std::vector<Kind> kinds;
    for (ViewerCommand command; link_.commands.TryPop(command);) kinds.push_back(command.kind);
    EXPECT_EQ(kinds, (std::vector{Kind::kSaveMesh, Kind::kSaveScan}));
}

// After the end of the run no system receives commands.
TEST_F(ViewerControls, AfterTheEndNothingIsSent) {
    Frames(2);
    link_.ended = true;
    Rounds(4);
    for (const char* name :
         {"pause", "step", "reset", "save_mesh", "record", "method.icp", "fusing"})
        Click(name);
    Key(XK_space);
    EXPECT_TRUE(link_.commands.empty());
    EXPECT_TRUE(link_.settings.empty());
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    Click("shading.Grey");
    EXPECT_TRUE(viewer_->RunOnce());
}

}  // namespace
}  // namespace tessera
