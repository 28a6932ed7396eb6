// The states that a resumed run starts from, and what a detection network may put out.
#include <algorithm>
#include <cstring>

#include "core/state_stream.h"
#include "fuzz/fuzz_target.h"
#include "semantics/yolo_outputs.h"
#include "support/box_room.h"
#include "system/mapping_stage.h"
#include "system/tracking_stage.h"

namespace tessera::fuzz {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

PipelineConfig SmallPipeline() {
    PipelineConfig config;
    config.map = {.voxel_size_m = 0.04, .truncation_m = 0.16};
    return config;
}

Frame RoomFrame(int i) {
    Frame frame = BoxRoom().Render(SmallCamera(), SmoothPath(i), i / 30.0);
    frame.index = i;
    return frame;
}

// A run of three frames, of whose map nothing changes afterwards.
struct SmallRun {
    SmallRun() {
        for (int i = 0; i < 3; ++i) {
            TrackedFrame tracked;
            tracking.Track(RoomFrame(i), mapping.map(), std::nullopt, tracked);
            mapping.Fuse(tracked);
        }
    }

    TrackingStage tracking{SmallPipeline(), SmallCamera()};
    MappingStage mapping{SmallPipeline(), {}, SmallCamera()};
};

const SmallRun& RunOnce() {
    static const SmallRun run;
    return run;
}

std::vector<Bytes> StateSeeds() {
    Bytes tracking{0}, labels{1};
    StateWriter to_tracking(tracking), to_labels(labels);
    RunOnce().tracking.SaveState(to_tracking);
    LabelMapper(LabelConfig{}, LabelClasses{}, SmallCamera()).SaveState(to_labels);
    return {tracking, labels};
}

// A state that is accepted can be tracked with; what it says is not checked.
void LoadStates(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    StateReader state(bytes.subspan(1));
    if (bytes[0] % 2 == 1) {
        LabelMapper labels(LabelConfig{}, LabelClasses{}, SmallCamera());
        if (labels.LoadState(state)) (void)labels.instances();
        return;
    }
    TrackingStage tracking(SmallPipeline(), SmallCamera());
    if (!tracking.LoadState(state)) return;
    static const Frame next = RoomFrame(3);
    TrackedFrame tracked;
    tracking.Track(next, RunOnce().mapping.map(), std::nullopt, tracked);
    TESSERA_CHECK(tracked.report.track.T_world_camera.matrix().allFinite(), "a pose is not finite");
}

// The family, the input's size / 32, the number of outputs, their shapes; then the numbers.
void DecodeNetwork(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 3) return;
    const auto family = static_cast<ModelFamily>(bytes[0] % 5);
    const int input_px = 32 * (1 + bytes[1] % 4), count = 1 + bytes[2] % 3;
    std::size_t at = 3;
    const auto next = [&] { return at < bytes.size() ? bytes[at++] : std::uint8_t{0}; };
    std::vector<OutputArray> outputs(static_cast<std::size_t>(count));
    std::vector<std::size_t> sizes;
    std::size_t numbers = 0;
    for (OutputArray& output : outputs) {
        output.shape = {1};
        std::size_t size = 1;
        for (int i = next() % 4; i > 0; --i) {
            output.shape.push_back(next() + 256 * (next() % 2));
            size *= static_cast<std::size_t>(output.shape.back());
        }
        if (size > 1 << 20) return;
        sizes.push_back(size);
        numbers += size;
    }
    std::vector<float> values(numbers);
    for (std::size_t i = 0; i < numbers; ++i) {
        std::uint32_t bits = 0;
        for (int b = 0; b < 4; ++b) bits = bits << 8 | next();
        if (at >= bytes.size()) at = std::min<std::size_t>(3, bytes.size());  // again and again
        std::memcpy(&values[i], &bits, sizeof(bits));
    }
    std::size_t begin = 0;
    for (std::size_t i = 0; i < outputs.size(); begin += sizes[i++])
        outputs[i].data = values.data() + begin;
    const Result<YoloLayout> layout = RecogniseOutputs(outputs, input_px, family);
    if (!layout.ok()) return;
    std::vector<RawDetection> found = DecodeOutputs(layout.value(), outputs, 0.3f);
    if (found.size() > 200) found.resize(200);
    SuppressOverlaps(0.5f, found);
    for (const RawDetection& one : found) {
        TESSERA_CHECK(one.class_index >= 0 && one.class_index < layout.value().classes,
                      "class {} of {}", one.class_index, layout.value().classes);
        if (layout.value().mask_coefficients > 0)
            (void)MaskOf(layout.value(), outputs, one, {2, 3, 20, 30}, 1.1, 0.9);
    }
}

std::vector<Bytes> NetworkSeeds() {
    std::vector<Bytes> seeds;
    // YOLOX and YOLOv8 for 64 pixels: 84 cells.
    for (const auto& [rows, columns] : {std::pair{84, 7}, {6, 84}, {4 + 2 + 32, 84}}) {
        Bytes seed = {0,
                      1,
                      static_cast<std::uint8_t>(rows > 30 && rows != 84 ? 1 : 0),
                      2,
                      static_cast<std::uint8_t>(rows),
                      0,
                      static_cast<std::uint8_t>(columns),
                      0};
        if (seed[2] == 1) seed.insert(seed.end(), {3, 32, 0, 16, 0, 16, 0});
        for (int i = 0; i < 200; ++i)
            seed.insert(seed.end(), {0x3f, static_cast<std::uint8_t>(40 + i % 60), 0, 0});
        seeds.push_back(seed);
    }
    return seeds;
}

}  // namespace

std::vector<FuzzTarget> StateTargets() {
    return {{"states", StateSeeds, LoadStates, 300},
            {"network_outputs", NetworkSeeds, DecodeNetwork}};
}

}  // namespace tessera::fuzz
