// Objects in the map and detections: a list, names over the 3D view, boxes over the image.
#include <fmt/format.h>

#include <algorithm>

#include "viz/name_plates.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

// One row: colour, number and class, probability, observations.
void DrawRow(ViewerState& state, SceneView& scene, const MapObject& object) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string name = fmt::format("object.{}", object.id);
    if (ImGui::Selectable(
            fmt::format("      {} {}##{}", object.id, object.class_name, name).c_str(),
            state.selected_object == object.id, ImGuiSelectableFlags_SpanAllColumns)) {
        state.selected_object = object.id;
        state.view.follow = state.view.keep_all = false;
        scene.camera().LookAt(object.centroid);
    }
    state.controls.MarkLast(name);
    Tip("Centre the view on this object");
    const ImVec2 at = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const float middle = (at.y + to.y) / 2;
    ImGui::GetWindowDrawList()->AddRectFilled({at.x + Scaled(3), middle - Scaled(4)},
                                              {at.x + Scaled(11), middle + Scaled(4)},
                                              Packed(object.colour), Scaled(2));
    ImGui::TableNextColumn();
    ImGui::Text("%.0f %%", 100 * object.probability);
    ImGui::TableNextColumn();
    ImGui::Text("%d x", object.observations);
}

}  // namespace

void DrawObjectsPanel(ViewerState& state, SceneView& scene) {
    GroupTitle("OBJECTS");
    DrawDetectorPanel(state);
    const auto& objects = state.system.objects();
    if (objects.empty()) return;
    // At most half of the remaining space; the rest is for the messages.
    ImGui::PushFont(SmallFont());
    const float row = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    const float height = std::min(static_cast<float>(objects.size()) * row + Scaled(2),
                                  std::max(0.5f * ImGui::GetContentRegionAvail().y, 3 * row));
    if (ImGui::BeginTable("objects", 3, ImGuiTableFlags_ScrollY, {0, height})) {
        ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
        ImGui::TableSetupColumn("probability", ImGuiTableColumnFlags_WidthFixed, Scaled(40));
        ImGui::TableSetupColumn("observations", ImGuiTableColumnFlags_WidthFixed, Scaled(44));
        for (const MapObject& object : objects) DrawRow(state, scene, object);
        ImGui::EndTable();
    }
    ImGui::PopFont();
}

// Nearer objects come first, so that they get their preferred position.
void DrawObjectNames(const ViewerState& state, const SceneView& scene, const ControlRect& area) {
    if (!state.view.show_objects) return;
    struct Name {
        Eigen::Vector3d pixel;
        const MapObject* object;
    };
    std::vector<Name> names;
    for (const MapObject& object : state.system.objects())
        if (const auto pixel = scene.PixelOf(object.T_world_oriented.translation()))
            names.push_back({*pixel, &object});
    std::ranges::stable_sort(names, {}, [](const Name& name) { return name.pixel.z(); });
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    NamePlates plates(list, 1);
    for (const auto& [pixel, object] : names) {
        const ImVec2 at{area.x + static_cast<float>(pixel.x()) / scale.x,
                        area.y + static_cast<float>(pixel.y()) / scale.y};
        plates.Draw(at, object->colour, fmt::format("{} {}", object->class_name, object->id),
                    object->id == state.selected_object);
    }
    list.PopClipRect();
}

// Detections fade as newer images arrive, because the detector lags behind.
void DrawDetections(const ViewerState& state, const ImVec2& from, const ImVec2& to) {
    constexpr double kShown_s = 1.5;
    const LabelUpdate& labels = state.system.labels();
    const ImageUpdate& images = state.system.images();
    if (!state.view.show_objects || !images.frame || images.frame->colour.empty()) return;
    const double age = std::abs(images.frame->stamp_s - labels.stamp_s) / kShown_s;
    if (age >= 1) return;
    const auto opacity = static_cast<float>(1 - age);
    const float x_scale = (to.x - from.x) / static_cast<float>(images.frame->colour.width());
    const float y_scale = (to.y - from.y) / static_cast<float>(images.frame->colour.height());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(from, to, true);
    for (const LabelUpdate::Shown& shown : labels.detections) {
        const ImVec2 low{from.x + x_scale * shown.box.x_min, from.y + y_scale * shown.box.y_min};
        const ImVec2 high{from.x + x_scale * (shown.box.x_max + 1),
                          from.y + y_scale * (shown.box.y_max + 1)};
        list.AddRect(low, high, Packed(shown.colour, static_cast<unsigned>(255 * opacity)),
                     Scaled(2), 0, Scaled(1.5f));
    }
    NamePlates plates(list, opacity);
    for (const LabelUpdate::Shown& shown : labels.detections)
        plates.Draw({from.x + x_scale * shown.box.x_min, from.y + y_scale * shown.box.y_min},
                    shown.colour, shown.name, false);
    list.PopClipRect();
}

}  // namespace tessera
