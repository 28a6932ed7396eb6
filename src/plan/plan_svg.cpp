#include <fmt/format.h>

#include <map>
#include <numbers>

#include "plan/plan_drawing.h"
#include "plan/plan_files.h"
#include "plan/svg_canvas.h"

namespace tessera {
namespace {

constexpr double kMargin_mm = 12, kFooter_mm = 24, kPaper_mm = 300;
constexpr const char* kThin = R"(stroke="#222" stroke-width="0.18")";
constexpr const char* kWallFill = "fill=\"#2c2f36\" stroke=\"#2c2f36\" stroke-width=\"0.1\"";
constexpr const char* kFaceFill = "fill=\"#8b9099\" stroke=\"#2c2f36\" stroke-width=\"0.1\"";
constexpr const char* kDimension = R"(stroke="#3565a8" stroke-width="0.15")";
constexpr const char* kDimensionText = R"(fill="#3565a8")";

// The usual scale at which the drawing fits on paper.
double ScaleFor(const Eigen::AlignedBox2d& bounds) {
    for (const double scale : {20, 50, 100, 200, 500, 1000})
        if (1000 * bounds.sizes().maxCoeff() / scale <= kPaper_mm) return scale;
    return 2000;
}

// In a room or under its walls.
bool InARoom(const FloorPlan& plan, const Eigen::Vector2d& p) {
    constexpr double kWall = 0.15;
    return std::ranges::any_of(plan.rooms, [&](const PlanRoom& room) {
        for (const double x : {-kWall, kWall})
            for (const double y : {-kWall, kWall})
                if (Contains(room.outline, p + Eigen::Vector2d(x, y))) return true;
        return false;
    });
}

// Floor that is in no room, in squares of 10 cm, joined along x.
void DrawOpenFloor(const FloorPlan& plan, SvgCanvas& canvas) {
    constexpr double kSquare = 0.1;
    std::map<std::pair<int, int>, int> squares;  // y, x
    for (const Eigen::Vector2d& cell : plan.floor_cells)
        if (!InARoom(plan, cell))
            ++squares[{static_cast<int>(std::floor(cell.y() / kSquare)),
                       static_cast<int>(std::floor(cell.x() / kSquare))}];
    std::vector<Polygon2d> runs;
    std::pair<int, int> last{0, 0};
    for (const auto& [square, count] : squares) {
        if (count < 2) continue;
        const double x = kSquare * square.second, y = kSquare * square.first;
        if (!runs.empty() && square.first == last.first && square.second == last.second + 1)
            runs.back()[1].x() = runs.back()[2].x() = x + kSquare;
        else
            runs.push_back(
                {{x, y}, {x + kSquare, y}, {x + kSquare, y + kSquare}, {x, y + kSquare}});
        last = square;
    }
    canvas.Polygons(runs, R"(fill="#eef0f3")");
}

void DrawRooms(const FloorPlan& plan, SvgCanvas& canvas) {
    for (const PlanRoom& room : plan.rooms) {
        std::vector<Polygon2d> loops = room.holes;
        loops.push_back(room.outline);
        canvas.Polygons(loops, R"(fill="#faf5ea" fill-rule="evenodd")");
    }
}

void DrawObjects(const FloorPlan& plan, SvgCanvas& canvas) {
    for (const PlanObject& object : plan.objects) {
        canvas.Polygons({object.outline}, R"(fill="#dfe9dd" stroke="#5d7a58" stroke-width="0.15")");
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& corner : object.outline) middle += corner;
        canvas.Text(middle / static_cast<double>(object.outline.size()), 1.8, object.name,
                    R"(fill="#41593d")");
    }
}

void DrawWalls(const FloorPlan& plan, SvgCanvas& canvas) {
    for (const PlanWall& wall : plan.walls) {
        if (!wall.seen)
            canvas.Line(wall.begin, wall.end,
                        R"(stroke="#8b9099" stroke-width="0.35" stroke-dasharray="1.5 1")");
        else
            canvas.Polygons({WallOutline(plan, wall)}, wall.thickness_m ? kWallFill : kFaceFill);
    }
    for (const PlanOpening& opening : plan.openings) {
        const Polygon2d place = OpeningOutline(opening);
        canvas.Polygons({place}, R"(fill="#fff")");
        canvas.Lines({{place[0], place[3]}, {place[1], place[2]}}, kThin);
        canvas.Lines({{place[0], place[1]}, {place[2], place[3]}},
                     R"(stroke="#222" stroke-width="0.18" stroke-dasharray="0.9 0.7")");
    }
}

void DrawDimensions(const FloorPlan& plan, SvgCanvas& canvas) {
    const double mm = canvas.scale() / 1000;  // metres per millimetre of paper
    for (const PlanDimension& dimension : Dimensions(plan)) {
        const Eigen::Vector2d along = (dimension.to - dimension.from).normalized(),
                              away = dimension.away.normalized();
        std::vector<Polygon2d> lines{{dimension.from, dimension.to}};
        for (const Eigen::Vector2d& end : {dimension.from, dimension.to}) {
            lines.push_back({end - 0.85 * dimension.away, end + mm * away});
            lines.push_back({end - 0.7 * mm * (along + away), end + 0.7 * mm * (along + away)});
        }
        canvas.Lines(lines, kDimension);
        canvas.Text((dimension.from + dimension.to) / 2 + 1.6 * mm * away, 2.2,
                    MeasureText(dimension.length_m), kDimensionText, along);
    }
    for (const PlanOpening& opening : plan.openings)
        canvas.Text((opening.begin + opening.end) / 2 +
                        (opening.thickness_m.value_or(0) / 2 + 1.8 * mm) * opening.normal,
                    2, MeasureText(opening.Width()), "", opening.end - opening.begin);
}

void DrawLabels(const FloorPlan& plan, SvgCanvas& canvas) {
    const double mm = canvas.scale() / 1000;
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
        const Eigen::Vector2d& at = plan.rooms[i].label_at;
        const Eigen::Vector2d down(0, -4.4 * mm);
        canvas.Text(at, 3, fmt::format("Room {}", i + 1), R"(font-weight="bold")");
        canvas.Text(at + down, 3.4, fmt::format("{:.2f} m²", plan.rooms[i].area_m2));
        canvas.Text(at + 1.9 * down, 2.2,
                    fmt::format("outline {:.2f} m", plan.rooms[i].perimeter_m), R"(fill="#666")");
    }
}

// Round lengths in black and white.
void DrawScaleBar(SvgCanvas& canvas, double x_mm, double y_mm) {
    const double step_m = canvas.scale() <= 20 ? 0.5 : canvas.scale() <= 100 ? 1 : 5;
    const double step_mm = 1000 * step_m / canvas.scale();
    for (int i = 0; i < 4; ++i)
        canvas.Raw(
            fmt::format(R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="1.6" fill="{}" {}/>)",
                        x_mm + i * step_mm, y_mm, step_mm, i % 2 == 0 ? "#222" : "#fff", kThin));
    for (const int i : {0, 2, 4})
        canvas.Caption(x_mm + i * step_mm, y_mm - 1, 2,
                       fmt::format("{:g}{}", i * step_m, i == 4 ? " m" : ""),
                       R"(text-anchor="middle")");
}

// An arrow along the first camera's view: a scan knows no north.
void DrawArrow(const FloorPlan& plan, SvgCanvas& canvas, double x_mm, double y_mm) {
    const double degrees =
        std::atan2(plan.first_view.x(), plan.first_view.y()) * 180 / std::numbers::pi;
    canvas.Raw(fmt::format(
        R"svg(<path transform="translate({:.2f} {:.2f}) rotate({:.2f})" d="M0 -6L2.4 4L0 2.4L-2.4 4Z"/>)svg",
        x_mm, y_mm, degrees));
    canvas.Caption(x_mm, y_mm + 9, 1.9, "first view", R"(text-anchor="middle" fill="#555")");
}

void DrawNotes(const FloorPlan& plan, const std::string& title, SvgCanvas& canvas) {
    double area_m2 = 0;
    for (const PlanRoom& room : plan.rooms) area_m2 += room.area_m2;
    const std::string rooms =
        plan.rooms.empty() ? fmt::format("no closed room; {:.1f} m² of floor seen", plan.floor_m2)
                           : fmt::format("{} closed room{}, {:.2f} m²", plan.rooms.size(),
                                         plan.rooms.size() == 1 ? "" : "s", area_m2);
    const std::string ceiling =
        plan.ceiling_m ? fmt::format("ceiling at {:.2f} m", *plan.ceiling_m) : "no ceiling seen";
    const double y = canvas.height_mm() - kFooter_mm;
    canvas.Caption(kMargin_mm, y + 1, 3.4, title, R"(font-weight="bold")");
    canvas.Caption(kMargin_mm, y + 5.6, 2.3,
                   fmt::format("1:{:g} · {} · {}", canvas.scale(), rooms, ceiling));
    canvas.Caption(kMargin_mm, y + 9.2, 2,
                   "Lengths in metres. Dark: both faces of the wall seen; grey: one face; dashed: "
                   "not seen.",
                   R"(fill="#555")");
    DrawScaleBar(canvas, kMargin_mm, y + 14.5);
}

}  // namespace

std::string PlanSvg(const FloorPlan& plan, const std::string& title) {
    Eigen::AlignedBox2d bounds = Bounds(plan);
    const double scale = ScaleFor(bounds), mm = scale / 1000;
    // Room for the notes beside a small drawing.
    const double missing = 110 * mm - bounds.sizes().x();
    if (missing > 0) {
        const Eigen::Vector2d more(missing / 2, 0);
        bounds = Eigen::AlignedBox2d(Eigen::Vector2d(bounds.min() - more),
                                     Eigen::Vector2d(bounds.max() + more));
    }
    SvgCanvas canvas(bounds, scale, kMargin_mm, kFooter_mm);
    DrawOpenFloor(plan, canvas);
    DrawRooms(plan, canvas);
    DrawObjects(plan, canvas);
    DrawWalls(plan, canvas);
    DrawDimensions(plan, canvas);
    DrawLabels(plan, canvas);
    DrawNotes(plan, title, canvas);
    DrawArrow(plan, canvas, canvas.width_mm() - kMargin_mm - 8,
              canvas.height_mm() - kFooter_mm + 6);
    return canvas.Finish("Floor plan of " + title);
}

}  // namespace tessera
