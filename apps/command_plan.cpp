// tessera plan: the floor plan of a run, a scan or a mesh.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <numbers>

#include "command.h"
#include "io/file.h"
#include "plan/plan_files.h"
#include "run/plan_run.h"

namespace tessera {
namespace {

struct PlanArguments {
    PlanRequest request;
    std::string out, title;
};

void Print(const FloorPlan& plan) {
    fmt::print("level: turned by {:.2f} degrees; noise of the floor {:.1f} mm\n",
               plan.tilt_rad * 180 / std::numbers::pi, 1000 * plan.noise_m);
    if (plan.skipped_triangles > 0)
        fmt::print("{} triangles left out: not finite, or more than 500 m away\n",
                   plan.skipped_triangles);
    double seen_m = 0;
    for (const PlanWall& wall : plan.walls) seen_m += wall.seen ? wall.Length() : 0;
    fmt::print(
        "{} walls, {:.2f} m; {} openings; {} objects; {}\n", plan.walls.size(), seen_m,
        plan.openings.size(), plan.objects.size(),
        plan.ceiling_m ? fmt::format("ceiling at {:.3f} m", *plan.ceiling_m) : "no ceiling seen");
    for (std::size_t i = 0; i < plan.rooms.size(); ++i)
        fmt::print("room {}: {:.2f} m2, outline {:.2f} m\n", i + 1, plan.rooms[i].area_m2,
                   plan.rooms[i].perimeter_m);
    if (plan.rooms.empty())
        fmt::print("no closed room: the walls that were seen enclose no floor ({:.1f} m2 of it)\n",
                   plan.floor_m2);
}

Status Plan(const PlanArguments& a) {
    const Result<FloorPlan> plan = PlanOfRun(a.request);
    if (!plan.ok()) return plan.status();
    if (Status status = PrepareOutputFolder(a.out); !status.ok()) return status;
    Print(plan.value());
    std::filesystem::path name(a.request.input);
    if (name.filename().empty()) name = name.parent_path();
    return WritePlan(a.out, plan.value(), a.title.empty() ? name.filename().string() : a.title);
}

}  // namespace

void AddPlanCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<PlanArguments>();
    CLI::App* command = app.add_subcommand(
        "plan",
        "Floor plan with measures of a run, a scan or a mesh: plan.svg, plan.dxf, plan.json");
    command->add_option("INPUT", a->request.input, "The folder of a run, FILE.scan or FILE.ply")
        ->required();
    command->add_option("--out", a->out, "Folder for the plan")->required()->type_name("DIR");
    command->add_option("--title", a->title, "Title of the drawing (default: INPUT's name)")
        ->type_name("TEXT");
    command
        ->add_option(
            "--up", a->request.up,
            "Which way is up in the mesh: x, y, z, -x, -y or -z (default: z for FILE.ply, else as "
            "the camera was held)")
        ->type_name("AXIS");
    command
        ->add_option("--noise", a->request.options.noise_m,
                     "Standard deviation of the surface, metres (default: that of the floor)")
        ->check(CLI::Range(0.0005, 0.1));
    command
        ->add_option("--least-room", a->request.options.least_room_m2,
                     "Smaller closed places are no rooms, square metres")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command->callback([a, &context] { context.exit_code = ExitCode(Plan(*a)); });
}

}  // namespace tessera
