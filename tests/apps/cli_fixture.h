// Runs the tessera program the way a user or a script does.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/temp_folder.h"

namespace tessera {

inline std::string ReadAll(const std::string& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Outcome {
    int exit_code;
    std::string out, err;
};

class Cli : public testing::Test {
  protected:
    Outcome Call(const std::string& arguments, const std::string& within = {}) const {
        const std::string command = within + TESSERA_PROGRAM + " " + arguments + " >" +
                                    (folder / "stdout") + " 2>" + (folder / "stderr") +
                                    " </dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadAll(folder / "stdout"),
                ReadAll(folder / "stderr")};
    }
    // What a command prints that must exit with 0.
    std::string Succeeds(const std::string& arguments) const {
        const Outcome outcome = Call(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
        return outcome.out;
    }
    // Bad input must give exit code 2 and one line on stderr that contains `named`.
    void ExpectRefused(const std::string& arguments, const std::string& named) const {
        const Outcome outcome = Call(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << "\n"
                                                                               << outcome.err;
        EXPECT_NE(outcome.err.find(named), std::string::npos) << arguments << "\n" << outcome.err;
    }
    // A run that takes about one second.
    static std::string SmallRun(const std::string& scene = "desk") {
        return "run synthetic:" + scene +
               " --set synthetic.width=160 --set synthetic.height=120 --set "
               "synthetic.fx=131 "
               "--set synthetic.fy=131 --set synthetic.cx=79.5 --set synthetic.cy=59.5 --set "
               "mapping.voxel_size_m=0.04 "
               "--set mapping.truncation_m=0.16 ";
    }
    TempFolder folder;
};

}  // namespace tessera
