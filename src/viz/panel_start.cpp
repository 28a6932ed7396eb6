// The start screen as a whole: its title, the pages, what is chosen in one line, the command line
// that does it, and the buttons.
#include <algorithm>

#include "core/printable.h"
#include "viz/start_state.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

constexpr ImU32 kBox = IM_COL32(19, 21, 24, 255);

// A box with a background, as wide and high as given, at the current place.
class [[nodiscard]] Box {
  public:
    Box(const char* name, const ImVec2& size) {
        ImGui::PushStyleColor(ImGuiCol_ChildBg, kBox);
        ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, Scaled(6));
        ImGui::BeginChild(name, size, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    }
    ~Box() {
        ImGui::EndChild();
        ImGui::PopStyleVar();
        ImGui::PopStyleColor();
    }
    Box(const Box&) = delete;
    Box& operator=(const Box&) = delete;
};

void DrawTitle() {
    ImGui::PushFont(TitleFont());
    ImGui::TextUnformatted("Tessera");
    ImGui::PopFont();
    ImGui::PushStyleColor(ImGuiCol_Text, palette::kDim);
    ImGui::TextUnformatted(
        "Scan a place with a depth camera or from a recording, or look at a "
        "finished scan.");
    ImGui::PopStyleColor();
    ImGui::Dummy({0, Scaled(4)});
}

void DrawPageButtons(StartState& state) {
    struct PageButton {
        StartPage page;
        const char *name, *label;
    };
    constexpr PageButton kButtons[] = {
        {StartPage::kFiles, "page.files", "Recording or finished scan"},
        {StartPage::kCamera, "page.camera", "Camera"},
        {StartPage::kDemo, "page.demo", "Built-in scene"}};
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
    for (const PageButton& button : kButtons) {
        if (button.page != StartPage::kFiles) ImGui::SameLine();
        if (MarkedButton(state.controls, button.name, button.label, width,
                         state.choices.page == button.page, Scaled(38)))
            state.ShowPage(button.page);
    }
}

// What is chosen, or what is wrong with it.
void DrawFinding(StartState& state) {
    const PathFinding found = state.finding();
    const bool bad = !state.error.empty() || found.failed;
    const std::string text = state.opening         ? "Opening ..."
                             : state.error.empty() ? found.text
                                                   : state.error;
    const ImU32 colour = state.opening || !(bad || found.can_run || found.can_view) ? palette::kIdle
                         : bad                                                      ? palette::kBad
                               : palette::kGood;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = 2 * ImGui::GetTextLineHeight() + Scaled(4);
    DrawLamp(*ImGui::GetWindowDrawList(), {at.x + Scaled(14), at.y + height / 2}, colour);
    const float left = at.x + Scaled(34), room = ImGui::GetContentRegionAvail().x - Scaled(34);
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str(), nullptr, false, room);
    const float top = at.y + std::max((height - extent.y) / 2, 0.0f);
    const ImVec4 clip{left, at.y, left + room, at.y + height};
    ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {left, top},
                                        palette::kText, text.c_str(), nullptr, room, &clip);
    ImGui::Dummy({ImGui::GetContentRegionAvail().x, height});
    if (extent.y > height) Tip(text.c_str());
    state.controls.MarkLast(state.opening ? "start.opening"
                            : bad         ? "start.error"
                                          : "start.finding");
}

void DrawCommand(StartState& state) {
    const std::vector<std::string> words = state.Words();
    const std::string line = ShellLine(words);
    const float width = ImGui::GetContentRegionAvail().x, button = Scaled(72);
    const float height = 2 * SmallFont()->FontSize + Scaled(14);
    {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {Scaled(10), Scaled(6)});
        const Box box("command", {width - button - ImGui::GetStyle().ItemSpacing.x, height});
        ImGui::PopStyleVar();
        ImGui::PushFont(SmallFont());
        ImGui::PushStyleColor(ImGuiCol_Text, palette::kDim);
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(words.empty() ? "The equivalent command appears here."
                                             : Printable(line).c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        ImGui::PopFont();
    }
    state.controls.MarkLast("command");
    if (!words.empty()) state.controls.MarkLast("command." + words[1]);  // run or view
    Tip("The command that does the same");
    ImGui::SameLine();
    ImGui::BeginDisabled(words.empty());
    if (MarkedButton(state.controls, "command.copy", "Copy", button, false, height))
        ImGui::SetClipboardText(line.c_str());
    Tip("Copy the command");
    ImGui::EndDisabled();
}

void DrawDecision(StartState& state) {
    const float width = Scaled(150), height = Scaled(38), gap = ImGui::GetStyle().ItemSpacing.x;
    const auto button = [&](const char* name, const char* label, bool enabled, bool lit,
                            const char* tip) {
        ImGui::BeginDisabled(!enabled);
        const bool pressed =
            MarkedButton(state.controls, name, label, width, enabled && lit, height);
        ImGui::EndDisabled();
        Tip(tip);
        return pressed;
    };
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - 3 * width -
                         2 * gap);
    if (button("close", "Close", true, false, "Ends the program  (Escape)")) state.close = true;
    ImGui::SameLine();
    if (button("open", "Open", state.can_open(), !state.can_start(), "Shows the finished scan"))
        state.Open();
    ImGui::SameLine();
    if (button("start", "Start", state.can_start(), true, "Begins to scan  (Enter)")) state.Start();
}

}  // namespace

void DrawStart(StartState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    // In the middle of a large window.
    const ImVec2 margin{std::max(Scaled(24), (size.x - Scaled(1160)) / 2),
                        std::max(Scaled(16), (size.y - Scaled(760)) / 2)};
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, margin);
    const Panel panel("start", {0, 0, size.x, size.y});
    ImGui::PopStyleVar();
    DrawTitle();
    ImGui::BeginDisabled(state.opening);
    DrawPageButtons(state);
    const float gap = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
    const float below = 2 * ImGui::GetTextLineHeight() + 2 * SmallFont()->FontSize + Scaled(80);
    const float height = std::max(ImGui::GetContentRegionAvail().y - below, Scaled(120));
    const float right = std::clamp(0.38f * room, Scaled(270), Scaled(400));
    {
        const Box box("page", {room - right - gap, height});
        DrawStartPage(state);
    }
    ImGui::SameLine();
    {
        const Box box("settings", {right, height});
        DrawStartSettings(state);
    }
    DrawFinding(state);
    DrawCommand(state);
    ImGui::Dummy({0, Scaled(2)});
    DrawDecision(state);
    ImGui::EndDisabled();
}

}  // namespace tessera
