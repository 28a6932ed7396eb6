#include "eval/label_scores.h"

#include <algorithm>
#include <cmath>

#include "eval/label_run.h"
#include "eval/label_truth.h"

namespace tessera {
namespace {

constexpr std::size_t kLookedUpFrames = 100;  // of the ground truth, to label the vertices
constexpr double kStray = 0.005;

// [D18] Table 4, by class.
void AddDetectionScores(const RunLabels& run, LabelScores& scores) {
    for (const auto& [instance, object] : ScoreDetections(run.images, run.wanted, 0).objects) {
        ClassScore& score = scores.classes[object.class_name];
        score.visible += object.visible;
        score.detected += object.detected;
        score.correct += object.right;
        score.probability_sum += object.probability_sum;
    }
}

std::string NameOf(const std::map<int, std::string>& names, int id) {
    const auto found = names.find(id);
    return found == names.end() ? std::string() : found->second;
}

// True class name of a vertex; "" for background and classes that the run did not look for.
std::string TrueName(const LabelTruth& truth, const LabelScores& scores, int class_id) {
    const std::string name = NameOf(truth.class_names, class_id);
    return scores.classes.contains(name) ? name : std::string();
}

void ScoreVertices(const LabelTruth& truth, const RunLabels& run,
                   const std::vector<VertexLabel>& labels, const std::vector<std::uint8_t>& seen,
                   LabelScores& scores) {
    std::int64_t right = 0, objects = 0, right_objects = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (seen[i] == 0) continue;
        const std::string is = TrueName(truth, scores, labels[i].class_id),
                          said = NameOf(run.class_names, run.mesh.labels[i].class_id);
        ++scores.vertices;
        right += is == said;
        objects += !is.empty();
        right_objects += !is.empty() && is == said;
        if (!is.empty()) ++scores.classes[is].vertices;
        if (!said.empty()) ++scores.classes[said].labelled;
        if (!is.empty() && is == said) ++scores.classes[is].both;
    }
    scores.accuracy = static_cast<double>(right) /
                      static_cast<double>(std::max<std::int64_t>(1, scores.vertices));
    scores.object_accuracy = static_cast<double>(right_objects) /
                             static_cast<double>(std::max<std::int64_t>(1, objects));
    int present = 0;
    for (const auto& [name, score] : scores.classes)
        if (score.vertices > 0) scores.mean_iou += score.Iou(), ++present;
    scores.mean_iou /= std::max(1, present);
}

using Points = std::vector<Eigen::Vector3d>;

Eigen::AlignedBox3d TrimmedBox(Points points) {
    Eigen::AlignedBox3d box;
    const auto cut = static_cast<std::size_t>(kStray * static_cast<double>(points.size()));
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::sort(points, {}, [axis](const Eigen::Vector3d& p) { return p[axis]; });
        box.min()[axis] = points[cut][axis];
        box.max()[axis] = points[points.size() - 1 - cut][axis];
    }
    return box;
}

double BoxIou(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
    const Eigen::AlignedBox3d both = a.intersection(b);
    if (both.isEmpty()) return 0;
    const double common = both.volume(), all = a.volume() + b.volume() - common;
    return all > 0 ? common / all : 0;
}

Eigen::Vector3d MeanOf(const Points& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
    return mean;
}

struct InstancePoints {
    std::map<int, Points> truth, found;
    std::map<int, int> class_of_found;
    std::map<std::pair<int, int>, std::int64_t> common;
};

InstancePoints Gather(const LabelTruth& truth, const RunLabels& run,
                      const std::vector<VertexLabel>& labels, const std::vector<std::uint8_t>& seen,
                      const LabelScores& scores) {
    InstancePoints points;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (seen[i] == 0) continue;
        const Eigen::Vector3d p = run.mesh.vertices[i].cast<double>();
        const int is = TrueName(truth, scores, labels[i].class_id).empty() ? 0 : labels[i].instance;
        const int said = run.mesh.labels[i].instance;
        if (is != 0) points.truth[is].push_back(p);
        if (said != 0) points.found[said].push_back(p);
        if (said != 0) points.class_of_found[said] = run.mesh.labels[i].class_id;
        if (is != 0 && said != 0) ++points.common[{is, said}];
    }
    const std::size_t least = 30;  // vertices per true object
    std::erase_if(points.truth, [&](const auto& entry) { return entry.second.size() < least; });
    return points;
}

void ScoreInstances(const LabelTruth& truth, const RunLabels& run, const InstancePoints& points,
                    LabelScores& scores) {
    std::set<int> good_25, good_50;
    int recalled_25 = 0, recalled_50 = 0, matched = 0;
    for (const auto& [id, its] : points.truth) {
        InstanceScore score;
        score.truth = id;
        score.class_name = TrueName(truth, scores, truth.class_of_instance.at(id));
        std::int64_t most = 0;
        for (const auto& [pair, count] : points.common)
            if (pair.first == id && count > most) most = count, score.found = pair.second;
        if (score.found != 0) {
            const Points& found = points.found.at(score.found);
            score.right_class =
                NameOf(run.class_names, points.class_of_found.at(score.found)) == score.class_name;
            score.box_iou = BoxIou(TrimmedBox(its), TrimmedBox(found));
            score.vertex_iou =
                static_cast<double>(most) /
                (static_cast<double>(its.size() + found.size()) - static_cast<double>(most));
            score.centroid_error_m = (MeanOf(its) - MeanOf(found)).norm();
            const bool is_25 =
                score.right_class && score.box_iou >= 0.25 && good_25.insert(score.found).second;
            const bool is_50 =
                score.right_class && score.box_iou >= 0.5 && good_50.insert(score.found).second;
            recalled_25 += is_25, recalled_50 += is_50;
            scores.centroid_error_mean_m += score.centroid_error_m, ++matched;
            scores.centroid_error_max_m =
                std::max(scores.centroid_error_max_m, score.centroid_error_m);
        }
        scores.instances.push_back(score);
    }
    scores.found_objects = static_cast<int>(points.found.size());
    scores.centroid_error_mean_m /= std::max(1, matched);
    const auto share = [](int part, std::size_t all) {
        return all > 0 ? part / static_cast<double>(all) : 0.0;
    };
    scores.precision_25 = share(recalled_25, points.found.size()),
    scores.recall_25 = share(recalled_25, points.truth.size());
    scores.precision_50 = share(recalled_50, points.found.size()),
    scores.recall_50 = share(recalled_50, points.truth.size());
}

}  // namespace

Result<LabelScores> EvaluateLabels(const std::string& sequence, const std::string& run_folder) {
    Result<LabelTruth> truth = ReadLabelTruth(sequence);
    if (!truth.ok()) return truth.status();
    const Result<RunLabels> run = ReadLabelRun(run_folder, truth.value());
    if (!run.ok()) return run.status();
    LabelScores scores;
    for (const std::string& name : run.value().wanted) scores.classes[name];
    AddDetectionScores(run.value(), scores);
    std::vector<VertexLabel> labels;
    std::vector<std::uint8_t> seen;
    const std::size_t stride =
        std::max<std::size_t>(1, truth.value().poses.size() / kLookedUpFrames);
    if (Status status = LookUpVertices(truth.value(), run.value().mesh, stride, labels, seen);
        !status.ok())
        return status;
    ScoreVertices(truth.value(), run.value(), labels, seen, scores);
    ScoreInstances(truth.value(), run.value(),
                   Gather(truth.value(), run.value(), labels, seen, scores), scores);
    std::erase_if(scores.classes, [](const auto& entry) {
        const ClassScore& score = entry.second;
        return score.visible == 0 && score.vertices == 0 && score.labelled == 0;
    });
    return scores;
}

}  // namespace tessera
