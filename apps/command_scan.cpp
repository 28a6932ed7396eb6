// tessera scan: maintenance of scan files.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "run/scan_merge.h"
#include "scan/scan_repair.h"

namespace tessera {
namespace {

struct ScanArguments {
    std::string scan, second, out;
};

int RepairTo(const ScanArguments& a) {
    const Result<RepairReport> repaired = RepairScan(a.scan, a.out);
    if (!repaired.ok()) return Fail(repaired.status());
    const RepairReport& report = repaired.value();
    fmt::print("{}: recovered {} blocks, {} frames of the path, {} raw frames, {} keyframes\n",
               a.out, report.blocks, report.path, report.frames, report.keyframes);
    if (report.lost.empty()) fmt::print("nothing was lost\n");
    for (const std::string& what : report.lost) fmt::print("lost: {}\n", what);
    return kExitDone;
}

int MergeTo(const ScanArguments& a) {
    const Result<MergeReport> merged = MergeScans(a.scan, a.second, a.out);
    if (!merged.ok()) return Fail(merged.status());
    const MergeReport& report = merged.value();
    fmt::print(
        "{}: {} frames, {} blocks, {} keyframes; {} keyframes of {} were found in {}, {} "
        "alignments across\n",
        a.out, report.frames, report.blocks, report.keyframes, report.places, a.second, a.scan,
        report.overlaps);
    return kExitDone;
}

}  // namespace

void AddScanCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<ScanArguments>();
    CLI::App* command = app.add_subcommand("scan", "Maintain scan files");
    command->require_subcommand(1);
    CLI::App* repair = command->add_subcommand(
        "repair", "Recover what is intact in a damaged scan into a new file");
    repair->add_option("SCAN", a->scan, "Damaged file; not modified")->required();
    repair->add_option("--out", a->out, "New file")->required()->type_name("FILE");
    CLI::App* merge = command->add_subcommand(
        "merge", "Merge two scans that overlap into a new one, in the world of the first");
    merge->add_option("FIRST", a->scan, "Scan with loop closure; not modified")->required();
    merge->add_option("SECOND", a->second, "Scan with the same camera and voxels; not modified")
        ->required();
    merge->add_option("--out", a->out, "New file")->required()->type_name("FILE");
    merge->callback([a, &context] { context.exit_code = MergeTo(*a); });
    repair->callback([a, &context] { context.exit_code = RepairTo(*a); });
}

}  // namespace tessera
