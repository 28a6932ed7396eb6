// tessera scan: maintenance of scan files.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "scan/scan_repair.h"

namespace tessera {
namespace {

struct Arguments {
    std::string scan, out;
};

int RepairTo(const Arguments& a) {
    const Result<RepairReport> repaired = RepairScan(a.scan, a.out);
    if (!repaired.ok()) return Fail(repaired.status());
    const RepairReport& report = repaired.value();
    fmt::print("{}: recovered {} blocks, {} frames of the path, {} raw frames, {} keyframes\n",
               a.out, report.blocks, report.path, report.frames, report.keyframes);
    if (report.lost.empty()) fmt::print("nothing was lost\n");
    for (const std::string& what : report.lost) fmt::print("lost: {}\n", what);
    return kExitDone;
}

}  // namespace

void AddScanCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("scan", "Maintain scan files");
    command->require_subcommand(1);
    CLI::App* repair = command->add_subcommand(
        "repair", "Recover what is intact in a damaged scan into a new file");
    repair->add_option("SCAN", a->scan, "Damaged file; not modified")->required();
    repair->add_option("--out", a->out, "New file")->required()->type_name("FILE");
    repair->callback([a, &context] { context.exit_code = RepairTo(*a); });
}

}  // namespace tessera
