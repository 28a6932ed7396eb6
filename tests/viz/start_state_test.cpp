#include "viz/start_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/temp_folder.h"
#include "viz/recent_paths.h"

namespace tessera {
namespace {

using EarlierRun = StartState::EarlierRun;
namespace fs = std::filesystem;

// What is said of the folder of the results, which is typed with "~" for the home folder.
class StartStateOutput : public testing::Test {
  protected:
    StartStateOutput() {
        if (const char* home = std::getenv("HOME")) home_before_ = home;
        setenv("HOME", folder_.path().c_str(), 1);
        fs::create_directory(folder_ / "done");
        std::ofstream(folder_ / "done/run.json") << "{}";
        services_.examine = [](const std::string&) { return PathFinding{}; };
        services_.list_cameras = [] { return OpenniListing{}; };
        services_.recent_file = folder_ / "recent";
    }
    ~StartStateOutput() override { setenv("HOME", home_before_.c_str(), 1); }
    static void Type(const std::string& text, StartState& state) {
        std::ranges::copy(text + '\0', state.typed_output.begin());
        state.Changed();
    }

    TempFolder folder_;
    std::string home_before_;
    StartServices services_;
};

TEST_F(StartStateOutput, AnEarlierRunThereIsToldOf) {
    StartState state(services_);
    Type("~/new", state);
    EXPECT_EQ(state.earlier_run(), EarlierRun::kNone);
    Type("~/done", state);
    EXPECT_EQ(state.earlier_run(), EarlierRun::kReplaced);
}

TEST_F(StartStateOutput, ACamerasRunIsKept) {
    services_.keeps_run = [this](const std::string& folder) { return folder == folder_ / "done"; };
    StartState state(services_);
    Type("~/done", state);
    EXPECT_EQ(state.earlier_run(), EarlierRun::kKept);
}

TEST_F(StartStateOutput, ItIsRememberedAsTheCommandHasIt) {
    StartState state(services_);
    state.ShowPage(StartPage::kDemo);
    Type("~/new", state);
    state.Start();
    ASSERT_GT(state.decision.size(), 4u);
    EXPECT_EQ(state.decision[4], folder_ / "new");
    EXPECT_EQ(ReadRecentPaths(folder_ / "recent").at(0), folder_ / "new");
}

}  // namespace
}  // namespace tessera
