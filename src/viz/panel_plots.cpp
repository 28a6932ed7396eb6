// Rolling plots of the run's figures.
#include <array>
#include <vector>

#include "viz/panels.h"
#include "viz/plot.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

std::vector<Curve> QueueCurves(const SystemView::History& history) {
    std::vector<Curve> curves;
    for (const auto& [name, series] : history.queued)
        curves.push_back(
            {name.c_str(), &series, palette::kCurves[curves.size() % std::size(palette::kCurves)]});
    return curves;
}

}  // namespace

void DrawPlotsPanel(const ViewerState& state, const ControlRect& area) {
    const Panel panel("plots", area);
    const SystemView::History& h = state.system.history();
    const auto& colours = palette::kCurves;
    const std::array stages{
        Curve{"track", &h.track_ms, colours[0]},     Curve{"fuse", &h.fuse_ms, colours[1]},
        Curve{"mesh", &h.mesh_ms, colours[2]},       Curve{"decode", &h.decode_ms, colours[3]},
        Curve{"prepare", &h.prepare_ms, colours[4]}, Curve{"latency", &h.latency_ms, colours[5]}};
    const std::array inliers{Curve{"inliers", &h.inlier_percent, colours[2]}};
    const std::array rms{Curve{"rms", &h.rms_mm, colours[0]}};
    const std::array map{Curve{"map", &h.map_mb, colours[4]}};
    const std::array dropped{Curve{"dropped", &h.dropped, colours[5]}};
    const std::vector<Curve> queues = QueueCurves(h);

    const float gap_x = ImGui::GetStyle().ItemSpacing.x + Scaled(4),
                gap_y = ImGui::GetStyle().ItemSpacing.y;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const ImVec2 wide{0.57f * room.x, (room.y - gap_y) / 2};
    const ImVec2 narrow{(room.x - wide.x - 2 * gap_x) / 2, wide.y};
    const auto next = [&] { ImGui::SameLine(0, gap_x); };
    DrawPlot("Time", "ms", stages, wide);
    next();
    DrawPlot("Inliers", "%", inliers, narrow, 100);
    next();
    DrawPlot("Distance rms", "mm", rms, narrow);
    DrawPlot("Queues", "", queues, wide);
    next();
    DrawPlot("Map", "MB", map, narrow);
    next();
    DrawPlot("Dropped", "", dropped, narrow);
}

}  // namespace tessera
