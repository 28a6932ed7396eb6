#include "run/open_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(OpenSource, ASceneByItsName) {
    const auto source = OpenSource("synthetic:desk", RunConfig());
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_TRUE(source.value()->info().has_truth);
    EXPECT_GT(source.value()->info().frame_count, 100);
}

TEST(OpenSource, WhatIsWrongIsNamed) {
    const TempFolder folder;
    std::ofstream(folder / "file.txt") << "x";
    const auto message = [](const std::string& name) {
        return OpenSource(name, RunConfig()).message();
    };
    EXPECT_EQ(message("/no/such"),
              "/no/such: no such folder (a source is a folder, FILE.oni, FILE.klg, FILE.scan, "
              "openni2: or synthetic:NAME)");
    EXPECT_NE(message(folder / "file.txt").find("is a file"), std::string::npos);
    EXPECT_NE(message("synthetic:dsk").find("desk"), std::string::npos) << message("synthetic:dsk");
    EXPECT_NE(message(folder.path()).find(folder.path()), std::string::npos);  // an empty folder
    EXPECT_EQ(message("a.klg"), "a.klg: no such file");
    EXPECT_NE(message("a.scan").find("a.scan"), std::string::npos) << message("a.scan");
}

}  // namespace
}  // namespace tessera
