// Tracking quality as a light, words and numbers.
#include <fmt/format.h>

#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

void DrawLight(const ViewerState& state) {
    const Quality light = state.quality();
    const ImU32 colour = ColourOf(light.level);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, Scaled(58)};
    const ImU32 faded = (colour & ~IM_COL32_A_MASK) | (26u << IM_COL32_A_SHIFT);
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, faded, Scaled(6));
    DrawLamp(list, {at.x + Scaled(22), at.y + Scaled(20)}, colour);
    const std::string note = state.recording() ? "recording" : "";
    list.AddText(HeadingFont(), HeadingFont()->FontSize, {at.x + Scaled(42), at.y + Scaled(10)},
                 palette::kText, light.title.c_str());
    const float note_width =
        SmallFont()->CalcTextSizeA(SmallFont()->FontSize, 1e4f, 0, note.c_str()).x;
    list.AddText(SmallFont(), SmallFont()->FontSize,
                 {at.x + size.x - note_width - Scaled(10), at.y + Scaled(13)}, palette::kBad,
                 note.c_str());
    const float wrap = size.x - Scaled(52);
    const ImVec4 clip{at.x, at.y, at.x + size.x, at.y + size.y};
    list.AddText(SmallFont(), SmallFont()->FontSize, {at.x + Scaled(42), at.y + Scaled(31)},
                 palette::kDim, light.reason.c_str(), nullptr, wrap, &clip);
    ImGui::Dummy(size);
    Tip(light.reason.c_str());
}

std::string Count(std::int64_t n) {
    return n < 100000     ? fmt::format("{}", n)
           : n < 10000000 ? fmt::format("{:.0f} k", static_cast<double>(n) / 1e3)
                          : fmt::format("{:.1f} M", static_cast<double>(n) / 1e6);
}

}  // namespace

void DrawStatusPanel(ViewerState& state, const SceneView& scene) {
    DrawLight(state);
    state.controls.MarkLast("status");
    if (!ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingStretchSame)) return;
    const FrameUpdate& frame = state.system.frame();
    const TrackResult& track = frame.report.track;
    const auto cell = [](const char* label, const std::string& value,
                         ImU32 colour = palette::kText) {
        ImGui::TableNextColumn();
        LabelledValue(label, value, colour);
    };
    ImGui::PushFont(SmallFont());
    cell("Frame", fmt::format("{}", frame.report.index));
    cell("Rate", fmt::format("{:.1f} fps", state.system.fps()));
    cell("Latency", fmt::format("{:.0f} ms", frame.latency_ms));
    cell("Dropped", Count(frame.counts.dropped),
         frame.counts.dropped > 0 ? palette::kWarning : palette::kText);
    cell("Inliers", fmt::format("{:.0f} %", 100 * track.inlier_fraction));
    cell("Distance", fmt::format("{:.1f} mm", 1000 * track.distance_rms_m));
    cell("Poor", Count(frame.counts.poor),
         frame.counts.poor > 0 ? palette::kWarning : palette::kText);
    cell("Lost", Count(frame.counts.lost), frame.counts.lost > 0 ? palette::kBad : palette::kText);
    cell("Blocks", Count(frame.map.blocks));
    cell("Map", fmt::format("{:.0f} MB", static_cast<double>(frame.map.bytes) / (1 << 20)));
    cell("Triangles", Count(static_cast<std::int64_t>(scene.triangles())));
    cell("Iterations", fmt::format("{}", track.iterations));
    ImGui::PopFont();
    ImGui::EndTable();
}

}  // namespace tessera
