// Tests that fusion never stops for good: whatever the constants, fusion resumes after frames that
// were not fused. Each trial multiplies all constants of scripts/reproduction/constants.txt by
// random factors of up to 1.5 in either direction, and runs the two stages of the engine on a small
// rendered sequence in which a hand covers the camera for a short time. docs/generality.md
// describes the protocol.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "synth/synthetic_source.h"
#include "system/pipeline.h"

namespace tessera {
namespace {

constexpr double kFactor = 1.5;
constexpr int kFrames = 40;
constexpr int kMostUnfused = kFrames / 3;  // at the end of a run
constexpr int kMostCovered = 8;
constexpr int kTrials = 150;  // about 10 s on two cores
constexpr PinholeCamera kCamera{120, 90, 98.5, 98.5, 59.5, 44.5};

// Maps each key in constants.txt to its kind: size, count or leave.
std::map<std::string, std::string> ListedConstants() {
    std::map<std::string, std::string> kinds;
    std::ifstream file(TESSERA_SOURCE_DIR "/scripts/reproduction/constants.txt");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind, key;
        if (words >> kind >> key && kind[0] != '#') {
            EXPECT_TRUE(kinds.emplace(key, kind).second) << key << " is listed twice";
        }
    }
    return kinds;
}

int NumberFromEnvironment(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atoi(text) : otherwise;
}

// Every third frame of a 30 Hz camera: fast enough that a tracker which stops fusing for long loses
// the camera.
std::vector<Frame> Rendered(const std::string& scene) {
    SynthConfig config;
    config.camera = kCamera;
    config.frames = kFrames;
    config.fps = 10;
    config.sensor.noise = NoiseModel::kKinect;
    auto source = OpenSyntheticScene(scene, config);
    EXPECT_TRUE(source.ok()) << source.message();
    std::vector<Frame> frames(kFrames);
    for (Frame& frame : frames) EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    return frames;
}

// A hand in front of the camera for some frames. It covers either some columns, too near to be
// measured, or the whole image. (A measured hand in part of the image looks like a moving scene and
// shifts the pose: docs/generality.md.)
struct Hand {
    int from = 0, count = 0;
    int columns = 0;
    float depth_m = 0;

    void Apply(Frame& frame) const {
        if (frame.index < from || frame.index >= from + count) return;
        for (int y = 0; y < kCamera.height; ++y)
            for (int x = 0; x < columns; ++x) {
                frame.depth_m(x, y) = depth_m;
                frame.colour(x, y) = {90, 60, 50};
            }
    }
};

struct Trial {
    PipelineConfig config;
    std::string scene;
    Hand hand;
    std::string text;  // describes all random choices
};

// 3 cm voxels instead of 1 cm, which match the low image resolution.
PipelineConfig SmallConfig() {
    PipelineConfig config;
    config.map = {.voxel_size_m = 0.03, .truncation_m = 0.12};
    return config;
}

class Latch : public testing::Test {
  protected:
    Trial Draw(int seed) const {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const auto below = [&random](std::uint64_t n) { return static_cast<int>(random() % n); };
        Trial trial;
        do {
            trial.config = SmallConfig();
            trial.config.trackers.method =
                kTrackingMethods[static_cast<std::size_t>(below(kTrackingMethods.size()))].method;
            trial.scene = std::next(scenes_.begin(), below(scenes_.size()))->first;
            Hand& hand = trial.hand;
            hand = {1 + below(kFrames / 2), below(kMostCovered + 1),
                    kCamera.width * (1 + below(4)) / 4, 0};
            if (below(2) == 0) hand = {hand.from, hand.count, kCamera.width, 0.6f};
            trial.text =
                fmt::format("seed {}: {}, {}, {} frames from {} covered to column {} at {} m", seed,
                            trial.scene, ToString(trial.config.trackers.method), hand.count,
                            hand.from, hand.columns, hand.depth_m);
            ConfigParameters parameters;
            trial.config.Describe(parameters);
            for (const ConfigParameters::Parameter& p : parameters.parameters()) {
                const auto listed = constants_.find(p.key);
                if (listed == constants_.end() || listed->second == "leave") continue;
                const double power = 2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1;
                const double value = std::stod(p.default_value) * std::pow(kFactor, power);
                const std::string text = listed->second == "count" ? fmt::format("{:.0f}", value)
                                                                   : fmt::format("{:.6g}", value);
                const Status set = parameters.Set(p.key, text);
                EXPECT_TRUE(set.ok()) << set.message();
                trial.text += fmt::format(" {}={}", p.key, text);
            }
        } while (!trial.config.Validate().ok());
        return trial;
    }

    // Returns an empty string or the error.
    std::string Run(const Trial& trial) const {
        Pipeline pipeline(trial.config, kCamera);
        int unfused = 0;
        std::string reason;
        for (Frame frame : scenes_.at(trial.scene)) {
            trial.hand.Apply(frame);
            const FrameReport report = pipeline.Process(frame);
            unfused = report.fused ? 0 : unfused + 1;
            if (!report.fused) reason = report.track.reason;
        }
        if (unfused <= kMostUnfused) return {};
        return fmt::format("the last {} of {} frames were not fused ({})\n{}", unfused, kFrames,
                           reason, trial.text);
    }

    const std::map<std::string, std::string> constants_ = ListedConstants();
    const std::map<std::string, std::vector<Frame>> scenes_ = {{"desk", Rendered("desk")},
                                                               {"corner", Rendered("corner")},
                                                               {"floor", Rendered("floor")},
                                                               {"wall", Rendered("wall")}};
};

// Every numeric setting must be either varied here or listed as left alone in constants.txt.
TEST(ConstantsList, EveryNumberOfFrameMappingTrackingAndMovingIsListed) {
    PipelineConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    std::set<std::string> numbers;
    for (const ConfigParameters::Parameter& p : parameters.parameters())
        if (p.allowed.starts_with("[")) numbers.insert(p.key);
    for (const auto& [key, kind] : ListedConstants()) {
        EXPECT_TRUE(numbers.erase(key) == 1) << key << " is not a numeric setting";
        EXPECT_TRUE(kind == "size" || kind == "count" || kind == "leave") << kind << " " << key;
    }
    for (const std::string& key : numbers)
        ADD_FAILURE() << key << " is missing in scripts/reproduction/constants.txt";
}

// TESSERA_LATCH_TRIALS sets the number of trials. TESSERA_LATCH_SEED sets the first seed, which
// reproduces a failure.
TEST_F(Latch, NoConstantsStopFusingForEver) {
    const int trials = NumberFromEnvironment("TESSERA_LATCH_TRIALS", kTrials);
    const int first = NumberFromEnvironment("TESSERA_LATCH_SEED", 1);
    std::printf("seeds %d to %d\n", first, first + trials - 1);
    std::vector<std::string> failures(static_cast<std::size_t>(trials));
    tbb::parallel_for(0, trials, [&](int i) {
        tbb::task_arena alone(1);  // a trial is too small to run on several threads
        alone.execute([&] { failures[static_cast<std::size_t>(i)] = Run(Draw(first + i)); });
    });
    for (const std::string& failure : failures) EXPECT_EQ(failure, "");
}

}  // namespace
}  // namespace tessera
