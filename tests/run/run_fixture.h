// A run on a small synthetic sequence, and access to the files it leaves.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run/run.h"
#include "support/temp_folder.h"

namespace tessera {

inline std::string ReadAll(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

class Run : public testing::Test {
  protected:
    // Few small frames, because this tests the run, not the tracker.
    Run() {
        config.synthetic.camera = {160, 120, 131.25, 131.25, 79.5, 59.5};
        config.synthetic.frames = 6;
        config.pipeline.map.voxel_size_m = 0.04;
        config.pipeline.map.truncation_m = 0.16;
        request.source = "synthetic:desk";
        request.output_folder = folder / "out";
        request.command_line = {"tessera", "run", "synthetic:desk"};
        observer.on_warning = [this](const std::string& text) { warnings.push_back(text); };
    }
    Result<RunSummary> Execute() { return ExecuteRun(request, config, observer, stop); }
    std::string Out(const std::string& name) const { return request.output_folder + "/" + name; }
    nlohmann::json Json(const std::string& name) const {
        return nlohmann::json::parse(ReadAll(Out(name)));
    }

    TempFolder folder;
    RunConfig config;
    RunRequest request;
    RunObserver observer;
    std::vector<std::string> warnings;
    std::atomic<bool> stop{false};
};

}  // namespace tessera
