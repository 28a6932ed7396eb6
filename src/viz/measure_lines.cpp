#include "viz/measure_lines.h"

#include "viz/theme.h"

namespace tessera {
namespace {

constexpr std::array<std::uint8_t, 4> kLineColour{kMeasuredColour.r, kMeasuredColour.g,
                                                  kMeasuredColour.b, 255};

void Append(const MeasuredEdge& edge, std::vector<LineVertex>& vertices) {
    for (const Eigen::Vector3d* p : {&edge.from, &edge.to})
        vertices.push_back(
            {{static_cast<float>(p->x()), static_cast<float>(p->y()), static_cast<float>(p->z())},
             kLineColour});
}

}  // namespace

bool MeasureLines::Update(const ViewerState& state) {
    if (taken_ == state.measuring.changes()) return false;
    taken_ = state.measuring.changes();
    std::vector<LineVertex> vertices;
    for (const Measurement& m : state.measuring.all()) {
        for (const MeasuredEdge& edge : EdgesOf(m)) Append(edge, vertices);
        const std::vector<Eigen::Vector3d> top = TopCorners(m);
        for (std::size_t i = 0; i < top.size(); ++i) {
            Append({top[i], top[(i + 1) % top.size()]}, vertices);
            Append({m.corners[i], top[i]}, vertices);
        }
    }
    lines_.Clear();
    if (!vertices.empty()) lines_.Append(vertices);
    return true;
}

void MeasureLines::Draw(const GlLineProgram& program, const GlLineProgram::View& view,
                        float opacity) {
    program.Draw(lines_, view, false, Scaled(2), opacity);
}

}  // namespace tessera
