// The pages of the start screen: files, cameras, built-in scenes.
#include <fmt/format.h>

#include "core/printable.h"
#include "viz/start_state.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

// A list as high as there is room; its lines end where the other controls do.
class [[nodiscard]] ListBox {
  public:
    ListBox() { ImGui::BeginChild("list"); }
    ~ListBox() { ImGui::EndChild(); }
    ListBox(const ListBox&) = delete;
    ListBox& operator=(const ListBox&) = delete;
};

// A line of a list, as wide as there is room; `detail` stands dim at its end.
bool ListLine(Controls& controls, const std::string& name, const std::string& text,
              const std::string& detail, bool chosen) {
    const float room = ImGui::GetContentRegionAvail().x;
    const float detail_width =
        detail.empty() ? 0 : ImGui::CalcTextSize(detail.c_str()).x + Scaled(16);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(name.c_str());
    const bool pressed = ImGui::Selectable("##line", chosen, ImGuiSelectableFlags_AllowDoubleClick,
                                           {room, ImGui::GetTextLineHeight() + Scaled(4)});
    ImGui::PopID();
    controls.MarkLast(name);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText({at.x + Scaled(6), at.y + Scaled(2)}, palette::kText,
                 FittedText(text, room - detail_width - Scaled(12)).c_str());
    if (!detail.empty())
        list.AddText({at.x + room - detail_width + Scaled(10), at.y + Scaled(2)}, palette::kDim,
                     detail.c_str());
    return pressed;
}

void DrawPathField(StartState& state) {
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ImGui::InputTextWithHint("##path", "path of a folder or file", state.typed_path.data(),
                                 state.typed_path.size()))
        state.Choose(state.typed_path.data());
    state.controls.MarkLast("path");
}

void DrawRecent(StartState& state) {
    constexpr int kShown = 4;
    if (state.recent().empty()) return;
    GroupTitle("OPENED LAST");
    std::string chosen;
    int number = 0;
    for (const std::string& path : state.recent()) {
        if (number == kShown) break;
        if (ListLine(state.controls, fmt::format("recent.{}", number++), Printable(path), "",
                     path == state.choices.path))
            chosen = path;
    }
    if (!chosen.empty()) state.Choose(chosen);
}

void DrawFolder(StartState& state) {
    GroupTitle("FOLDER");
    if (MarkedButton(state.controls, "folder.up", "Up", Scaled(48)))
        state.EnterFolder(FolderAbove(state.folder()));
    Tip("To the folder that holds this one");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const std::string here = state.folder() == "." ? "where you are" : Printable(state.folder());
    ImGui::TextUnformatted(FittedText(here, ImGui::GetContentRegionAvail().x).c_str());
    std::string chosen, entered;
    {
        const ListBox list;
        for (const FolderEntry& entry : state.list().entries) {
            const bool pressed =
                ListLine(state.controls, "entry." + entry.name, entry.name,
                         entry.folder ? "folder" : "", entry.path == state.choices.path);
            if (pressed)
                (ImGui::IsMouseDoubleClicked(0) && entry.folder ? entered : chosen) = entry.path;
        }
        if (!state.list().note.empty()) SmallText(palette::kDim, state.list().note);
    }
    if (!entered.empty()) state.EnterFolder(entered);
    if (!chosen.empty()) state.Choose(chosen);
}

void DrawFiles(StartState& state) {
    DrawPathField(state);
    SmallText(palette::kDim,
              "Type a path, or click on one below. A double click goes into a folder.");
    DrawRecent(state);
    DrawFolder(state);
}

void DrawCameras(StartState& state) {
    ImGui::BeginDisabled(!state.cameras());
    if (MarkedButton(state.controls, "cameras.refresh", "Refresh", Scaled(90)))
        state.RefreshCameras();
    ImGui::EndDisabled();
    Tip("Looks for cameras again");
    GroupTitle("DEPTH CAMERAS");
    if (!state.cameras()) return SmallText(palette::kDim, "Looking ...");
    const ListBox list;
    for (const OpenniDevice& device : state.cameras()->devices)
        if (ListLine(state.controls, "camera." + device.uri,
                     Printable(device.vendor + " " + device.name), Printable(device.uri),
                     state.choices.camera == device.uri)) {
            state.choices.camera = device.uri;
            state.Changed();
        }
    if (!state.cameras()->devices.empty()) return;
    const auto& advice = state.cameras()->advice;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(advice.empty() ? "No depth camera was found."
                                          : Printable(advice.front()).c_str());
    ImGui::PopTextWrapPos();
    state.controls.MarkLast("cameras.none");
    SmallText(palette::kDim, "Plug it in and press Refresh. tessera doctor says more.");
}

void DrawScenes(StartState& state) {
    SmallText(palette::kDim, "To try without a camera: the program draws what one would see.");
    GroupTitle("BUILT-IN SCENES");
    const ListBox list;
    for (const DemoScene& scene : DemoScenes())
        if (ListLine(state.controls, std::string("scene.") + scene.name, scene.text, scene.name,
                     state.choices.scene == scene.name)) {
            state.choices.scene = scene.name;
            state.Changed();
        }
}

}  // namespace

void DrawStartPage(StartState& state) {
    switch (state.choices.page) {
        case StartPage::kFiles: return DrawFiles(state);
        case StartPage::kCamera: return DrawCameras(state);
        case StartPage::kDemo: return DrawScenes(state);
    }
}

}  // namespace tessera
