// The time line of a finished run: a slider, and the figures and the image of its frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

ImU32 ColourOfFrame(FrameState state) {
    switch (state) {
        case FrameState::kFused: return palette::kGood;
        case FrameState::kTracked: return palette::kWarning;
        case FrameState::kLost: return palette::kBad;
    }
    return palette::kIdle;
}

const char* TextOfFrame(FrameState state) {
    switch (state) {
        case FrameState::kFused: return "good";
        case FrameState::kTracked: return "not added";
        case FrameState::kLost: return "lost";
    }
    return "";
}

// Where frames were lost or not added, as marks along the slider's rail: the worst in each pixel.
void DrawStates(ImDrawList& list, const TimeLine& line, const ImVec2& at, const ImVec2& size) {
    const std::size_t count = line.frames.size();
    const auto columns = static_cast<std::size_t>(std::max(size.x, 1.0f));
    for (std::size_t column = 0; column < columns; ++column) {
        // The last frame stands where the rail ends: in the last column.
        const std::size_t begin = column * (count - 1) / columns;
        const std::size_t end = column + 1 == columns
                                    ? count
                                    : std::max((column + 1) * (count - 1) / columns, begin + 1);
        FrameState worst = FrameState::kFused;
        for (std::size_t i = begin; i < end; ++i) worst = std::max(worst, line.frames[i].row.state);
        if (worst == FrameState::kFused) continue;
        const float x = at.x + static_cast<float>(column);
        list.AddRectFilled({x, at.y}, {x + 1, at.y + size.y}, ColourOfFrame(worst));
    }
}

void DrawSlider(ViewerState& state, float width) {
    Replay& replay = *state.replay;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{std::max(width, 1.0f), ImGui::GetFrameHeight()};
    ImGui::InvisibleButton("time_line", size);
    state.controls.MarkLast("time_line");
    const float inset = Scaled(8), rail = std::max(size.x - 2 * inset, 1.0f), left = at.x + inset;
    const auto last = static_cast<float>(replay.last());
    if (ImGui::IsItemActive()) {
        const float share = std::clamp((ImGui::GetIO().MousePos.x - left) / rail, 0.0f, 1.0f);
        replay.GoTo(static_cast<std::size_t>(std::lround(share * last)));
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = at.y + size.y / 2, half = Scaled(2.5f);
    const float x = left + rail * static_cast<float>(replay.position()) / last;
    list.AddRectFilled({left, y - half}, {left + rail, y + half}, IM_COL32(58, 63, 72, 255), half);
    list.AddRectFilled({left, y - half}, {x, y + half}, palette::kAccent, half);
    DrawStates(list, replay.line(), {left, y + half + Scaled(2)}, {rail, Scaled(3)});
    list.AddCircleFilled({x, y}, Scaled(ImGui::IsItemHovered() ? 8.5f : 7.5f), palette::kText);
    list.AddCircleFilled({x, y}, Scaled(4.5f), ColourOfFrame(replay.frame().row.state));
    Tip("Drag through the run  (Left, Right, Home, End)");
}

std::string PositionText(const TimeLine& line, const TimeLineFrame& frame) {
    return fmt::format("frame {}, {:.1f} of {:.1f} s", frame.row.index, frame.at_s,
                       line.frames.back().at_s);
}

// Its width, so that the slider's does not change.
float LongestPosition(const TimeLine& line) {
    return ImGui::CalcTextSize(PositionText(line, line.frames.back()).c_str()).x;
}

void DrawPosition(ViewerState& state, const std::string& text) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    state.controls.MarkLast(fmt::format("time_line.frame.{}", state.replay->frame().row.index));
}

void DrawFigures(ViewerState& state) {
    const TimeLineFrame& frame = state.replay->frame();
    const FrameRow& row = frame.row;
    const auto figure = [](const char* label, const std::string& value, ImU32 colour,
                           const char* tip) {
        ImGui::TableNextColumn();
        ImGui::BeginGroup();
        SmallText(palette::kDim, label);
        SmallText(colour, value);
        ImGui::EndGroup();
        Tip(tip);
    };
    const auto stage = [&](const char* label, double ms, const char* tip) {
        figure(label, fmt::format("{:.1f} ms", ms), palette::kText, tip);
    };
    if (!state.replay->line().has_figures ||
        !ImGui::BeginTable("figures", 8, ImGuiTableFlags_SizingStretchSame))
        return;
    figure("Status", TextOfFrame(row.state), ColourOfFrame(row.state),
           row.reason.empty() ? "good: tracked, and added to the map" : row.reason.c_str());
    figure("Inliers", fmt::format("{:.0f} %", 100 * row.inlier_fraction), palette::kText,
           "Share of the points that fit the map");
    figure("Distance", fmt::format("{:.1f} mm", 1000 * row.distance_rms_m), palette::kText,
           "Robust RMS of the points' distances from the map");
    stage("Decode", row.decode_ms, "Reading the images");
    stage("Prepare", row.prepare_ms, "Filtering depth, building pyramids");
    stage("Track", row.track_ms, "Finding the camera's pose");
    stage("Fuse", row.allocate_ms + row.fuse_ms, "Adding the frame to the map");
    stage("Frame", row.frame_ms, "All of it, waiting for its images included");
    ImGui::EndTable();
    state.controls.MarkLast("time_line.figures");
}

}  // namespace

void TimeLinePanel::Begin(FrameImages::Open open) {
    if (open) images_.emplace(std::move(open));
}

float TimeLinePanel::Height() { return Scaled(86); }

// The image of another frame would be wrong; while playing, the newest one may be a little late.
const GlTexture& TimeLinePanel::shown(const ViewerState& state) const {
    return has_ == asked_ || state.replay->playing() ? colour_ : none_;
}

bool TimeLinePanel::Update(const ViewerState& state) {
    if (!images_ || !state.replay) return false;
    const std::int64_t index = state.replay->frame().row.index;
    if (index != asked_) images_->Request(asked_ = index);
    std::optional<FrameImages::Image> image = images_->Take();
    if (!image) return false;
    has_ = image->index;
    if (image->colour.empty())
        colour_.Clear();
    else
        colour_.Set(image->colour);
    return true;
}

void TimeLinePanel::Draw(ViewerState& state, const SceneView& scene, const ControlRect& area,
                         const ControlRect& view) {
    Replay& replay = *state.replay;
    {
        const Panel panel("time line", area, ImGuiWindowFlags_NoScrollWithMouse);
        if (MarkedButton(state.controls, "time_line.play", replay.playing() ? "Pause" : "Play",
                         Scaled(72), replay.playing()))
            replay.TogglePlaying();
        Tip("At the recorded rate  (Space)");
        ImGui::SameLine();
        const std::string text = PositionText(replay.line(), replay.frame());
        DrawSlider(state,
                   ImGui::GetContentRegionAvail().x - LongestPosition(replay.line()) - Scaled(12));
        ImGui::SameLine();
        DrawPosition(state, text);
        DrawFigures(state);
    }
    if (const auto pixel = scene.PixelOf(replay.T_world_camera().translation())) {
        const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
        state.controls.Mark("time_line.camera",
                            {view.x + static_cast<float>(pixel->x()) / scale.x,
                             view.y + static_cast<float>(pixel->y()) / scale.y, 0, 0});
    }
    if (state.show_help) return;
    const Panel over("view", view, ImGuiWindowFlags_NoScrollWithMouse);  // adds to it
    DrawInset(state, shown(state), view);
}

}  // namespace tessera
