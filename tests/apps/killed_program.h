// Starts the program on a small sequence, to kill it with SIGKILL.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/temp_folder.h"

namespace tessera::testing_support {

class KilledProgram : public testing::Test {
  protected:
    using Clock = std::chrono::steady_clock;

    static double Seconds(Clock::duration duration) {
        return std::chrono::duration<double>(duration).count();
    }
    pid_t Start(const std::vector<std::string>& arguments) const {
        std::vector<char*> argv{const_cast<char*>(TESSERA_PROGRAM)};
        for (const std::string& argument : arguments)
            argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            const std::string log = folder / "log";
            if (std::freopen(log.c_str(), "a", stdout) == nullptr ||
                std::freopen(log.c_str(), "a", stderr) == nullptr)
                _exit(99);
            execv(TESSERA_PROGRAM, argv.data());
            _exit(98);
        }
        return child;
    }
    static int WaitFor(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int Call(const std::vector<std::string>& arguments) const { return WaitFor(Start(arguments)); }
    // Starts the program and kills it after this time.
    void Kill(const std::vector<std::string>& arguments, double after_s) const {
        const Clock::time_point start = Clock::now();
        const pid_t child = Start(arguments);
        std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                                  std::chrono::duration<double>(after_s)));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    std::string Log() const { return Bytes(folder / "log"); }

    static std::string Bytes(const std::string& path) {
        std::stringstream bytes;
        bytes << std::ifstream(path, std::ios::binary).rdbuf();
        return bytes.str();
    }
    void MakeSequence(const std::string& scene, int length) const {
        ASSERT_EQ(Call({"synth",    scene,
                        "--out",    sequence,
                        "--frames", std::to_string(length),
                        "--noise",  "kinect",
                        "--set",    "synthetic.width=320",
                        "--set",    "synthetic.height=240",
                        "--set",    "synthetic.fx=262.5",
                        "--set",    "synthetic.fy=262.5",
                        "--set",    "synthetic.cx=159.5",
                        "--set",    "synthetic.cy=119.5"}),
                  0)
            << Log();
    }

    TempFolder folder;
    std::string sequence = folder / "sequence";
};

}  // namespace tessera::testing_support
