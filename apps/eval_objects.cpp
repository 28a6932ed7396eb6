// tessera eval labels and tessera eval detections.
#include "eval_objects.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "eval/detection_run.h"
#include "eval/label_scores.h"
#include "io/file.h"
#include "semantics/label_config.h"

namespace tessera {
namespace {

struct ObjectArguments {
    std::string reference, estimate, json;
};

Status EvalLabels(const ObjectArguments& a) {
    const Result<LabelScores> scores = EvaluateLabels(a.reference, a.estimate);
    if (!scores.ok()) return scores.status();
    fmt::print("{}", LabelScoresText(scores.value()));
    return a.json.empty() ? Status::Ok() : WriteTextFile(a.json, LabelScoresJson(scores.value()));
}

struct DetectionArguments {
    double min_probability = LabelConfig().min_probability;
    std::string aliases = LabelConfig().aliases;
};

Status EvalDetections(const ObjectArguments& a, const DetectionArguments& d) {
    const Result<ClassAliases> aliases = ParseAliases(d.aliases);
    if (!aliases.ok()) return Status::Error("--aliases: " + aliases.message());
    const Result<DetectionScores> scores =
        EvaluateDetections(a.reference, a.estimate, aliases.value(), d.min_probability);
    if (!scores.ok()) return scores.status();
    fmt::print("{}", DetectionScoresText(scores.value()));
    return a.json.empty() ? Status::Ok()
                          : WriteTextFile(a.json, DetectionScoresJson(scores.value()));
}

// Adds an evaluation against a sequence with a true class and instance per pixel.
CLI::App* AddObjectEvaluation(CLI::App& eval, ObjectArguments& a, const char* name,
                              const char* text) {
    CLI::App* command = eval.add_subcommand(name, text);
    command
        ->add_option("SEQUENCE", a.reference,
                     "Folder with labels/, instances/, classes.txt, groundtruth.txt, as tessera "
                     "synth writes it")
        ->required();
    command->add_option("--json", a.json, "Write the figures to this file")->type_name("FILE");
    return command;
}

void AddDetections(CLI::App& eval, std::shared_ptr<ObjectArguments> a, CommandContext& context) {
    auto d = std::make_shared<DetectionArguments>();
    CLI::App* command =
        AddObjectEvaluation(eval, *a, "detections",
                            "Evaluate a detector by the true boxes of a sequence: precision, "
                            "recall, AP50 by class; [D18] Table 4 by object");
    command
        ->add_option("DETECTIONS", a->estimate,
                     "detections.txt, or the folder of a run with --labels")
        ->required();
    command
        ->add_option("--min-probability", d->min_probability,
                     "Count detections from this probability on; AP50 uses all that the file has")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    command
        ->add_option("--aliases", d->aliases,
                     "Rename classes, as labels.aliases, on both sides; a run's file knows its own")
        ->capture_default_str();
    command->callback([a, d, &context] { context.exit_code = ExitCode(EvalDetections(*a, *d)); });
}

}  // namespace

void AddObjectEvaluations(CLI::App& eval, CommandContext& context) {
    auto a = std::make_shared<ObjectArguments>();
    CLI::App* labels =
        AddObjectEvaluation(eval, *a, "labels",
                            "Evaluate the labels of a run's map by the true classes and instances "
                            "of a sequence");
    labels->add_option("RUN_DIR", a->estimate, "Folder of a run with --labels")->required();
    labels->callback([a, &context] { context.exit_code = ExitCode(EvalLabels(*a)); });
    AddDetections(eval, a, context);
}

}  // namespace tessera
