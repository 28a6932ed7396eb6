#include "viz/object_boxes.h"

#include "viz/theme.h"

namespace tessera {
namespace {

// Appends the twelve edges, two vertices each.
void AppendEdges(const MapObject& object, std::vector<LineVertex>& vertices) {
    const std::array<std::uint8_t, 4> colour{object.colour.r, object.colour.g, object.colour.b,
                                             255};
    const auto corner = [&](int which) {
        const Eigen::Vector3d side(which & 1 ? 0.5 : -0.5, which & 2 ? 0.5 : -0.5,
                                   which & 4 ? 0.5 : -0.5);
        const Eigen::Vector3f p =
            (object.T_world_oriented * side.cwiseProduct(object.oriented_size)).cast<float>();
        return LineVertex{{p.x(), p.y(), p.z()}, colour};
    };
    for (int from = 0; from < 8; ++from)
        for (const int axis : {1, 2, 4})
            if ((from & axis) == 0) {
                vertices.push_back(corner(from));
                vertices.push_back(corner(from | axis));
            }
}

}  // namespace

bool ObjectBoxes::Update(const ViewerState& state) {
    if (taken_ == state.system.objects_taken() && selected_id_ == state.selected_object)
        return false;
    taken_ = state.system.objects_taken();
    selected_id_ = state.selected_object;
    std::vector<LineVertex> edges, selected;
    for (const MapObject& object : state.system.objects())
        AppendEdges(object, object.id == selected_id_ ? selected : edges);
    edges_.Clear();
    selected_.Clear();
    if (!edges.empty()) edges_.Append(edges);
    if (!selected.empty()) selected_.Append(selected);
    return true;
}

void ObjectBoxes::Draw(const GlLineProgram& program, const GlLineProgram::View& view,
                       float opacity) {
    program.Draw(edges_, view, false, Scaled(1.5f), opacity);
    program.Draw(selected_, view, false, Scaled(3), opacity);
}

}  // namespace tessera
