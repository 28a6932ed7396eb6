#include "system/recorder_thread.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(RecorderThread, LeavesOutAFrameThatCannotBeRecordedAndGoesOn) {
    TempFolder folder;
    SourceInfo source;
    source.name = "camera";
    source.camera = {64, 48, 61.7, 60.3, 31.1, 24.2};
    Wake wake;
    Notices notices(wake);
    RecorderThread recorder(source, {}, true, notices);
    ASSERT_TRUE(recorder.Start(folder / "raw").ok());
    for (int i = 0; i < 5; ++i) {
        Frame frame;
        frame.index = i;
        frame.stamp_s = frame.colour_stamp_s = 1 + (i == 3 ? 0 : i) / 30.0;  // one step back
        frame.depth_m = DepthImage(64, 48, 1.0f);
        if (i != 1) frame.colour = ColourImage(64, 48);
        recorder.Add(frame);
    }
    recorder.Stop();
    std::vector<std::string> told;
    while (auto text = notices.Take()) told.push_back(*text);
    EXPECT_EQ(told, (std::vector<std::string>{
                        "recording to " + (folder / "raw"),
                        "recording goes on: camera: frame 1 cannot be recorded: it has no colour",
                        "recorded 3 frames in " + (folder / "raw") + "; 2 left out"}));
}

}  // namespace
}  // namespace tessera
