#include "eval/detection_scores.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr float kSameBox = 0.5f;

double ShareOf(double part, std::int64_t all) {
    return all > 0 ? part / static_cast<double>(all) : 0;
}

// Finds objects for detections. An object is found only once.
class Matcher {
  public:
    explicit Matcher(const std::vector<TrueObject>& objects)
        : objects_(&objects), taken_(objects.size()) {}

    // Takes and returns the object that `box` overlaps most, or null. Objects that do not count
    // are considered last. `class_name`: only objects of this class; null: of any.
    const TrueObject* Take(const DetectionBox& box, const std::string* class_name) {
        std::size_t best = objects_->size();
        float most = 0;
        for (std::size_t i = 0; i < objects_->size(); ++i) {
            const TrueObject& object = (*objects_)[i];
            if (taken_[i] || (class_name != nullptr && object.class_name != *class_name)) continue;
            const float overlap = BoxOverlap(object.box, box);
            if (overlap < kSameBox) continue;
            const float rank = overlap + (object.counts ? 1 : 0);
            if (rank > most) most = rank, best = i;
        }
        if (best == objects_->size()) return nullptr;
        taken_[best] = true;
        return &(*objects_)[best];
    }

  private:
    const std::vector<TrueObject>* objects_;
    std::vector<bool> taken_;
};

// A class's detection, and the image it is from.
struct Candidate {
    const DetectionRow* row;
    std::size_t image;
};

// Area under the envelope of precision over recall (all points, as in PASCAL VOC since 2010).
// `right`: detections by decreasing probability, true if right.
double AreaUnder(const std::vector<bool>& right, std::int64_t visible) {
    double area = 0, envelope = 0;
    auto correct = static_cast<double>(std::ranges::count(right, true));
    for (std::size_t i = right.size(); i-- > 0;) {
        envelope = std::max(envelope, correct / static_cast<double>(i + 1));
        if (!right[i]) continue;
        area += ShareOf(envelope, visible);
        --correct;
    }
    return area;
}

// `score.visible` is known before.
void ScoreClass(const std::vector<ScoredImage>& images, const std::string& name,
                std::vector<Candidate> candidates, double min_probability, DetectionScore& score) {
    std::ranges::stable_sort(candidates, std::greater{},
                             [](const Candidate& c) { return c.row->probability; });
    std::vector<Matcher> matchers;
    for (const ScoredImage& image : images) matchers.emplace_back(image.objects);
    std::vector<bool> right;
    for (const Candidate& c : candidates) {
        const TrueObject* object = matchers[c.image].Take(c.row->box, &name);
        if (object != nullptr && !object->counts) continue;
        right.push_back(object != nullptr);
        if (c.row->probability < static_cast<float>(min_probability)) continue;
        ++score.detections;
        score.true_positives += object != nullptr;
        score.probability_sum += c.row->probability;
    }
    score.average_precision = AreaUnder(right, score.visible);
}

void ScoreObjects(const ScoredImage& image, const std::set<std::string>& looked_for,
                  double min_probability, std::map<int, ObjectScore>& objects) {
    std::vector<const DetectionRow*> rows;
    for (const DetectionRow& row : image.detections)
        if (looked_for.contains(row.name) && row.probability >= static_cast<float>(min_probability))
            rows.push_back(&row);
    std::ranges::stable_sort(rows, std::greater{},
                             [](const DetectionRow* row) { return row->probability; });
    Matcher matcher(image.objects);
    for (const DetectionRow* row : rows) {
        const TrueObject* object = matcher.Take(row->box, nullptr);
        if (object == nullptr || !object->counts || !looked_for.contains(object->class_name))
            continue;
        ObjectScore& score = objects[object->instance];
        ++score.detected;
        score.right += object->class_name == row->name;
        score.probability_sum += row->probability;
    }
}

void CountVisible(const ScoredImage& image, const std::set<std::string>& looked_for,
                  DetectionScores& scores) {
    for (const TrueObject& object : image.objects) {
        if (!object.counts) continue;
        if (!looked_for.contains(object.class_name)) {
            ++scores.not_looked_for[object.class_name];
            continue;
        }
        ++scores.classes[object.class_name].visible;
        ObjectScore& score = scores.objects[object.instance];
        score.class_name = object.class_name;
        ++score.visible;
    }
}

void AddUp(DetectionScores& scores) {
    int visible_classes = 0;
    for (const auto& [name, score] : scores.classes) {
        scores.all.visible += score.visible;
        scores.all.detections += score.detections;
        scores.all.true_positives += score.true_positives;
        scores.all.probability_sum += score.probability_sum;
        scores.all.average_precision += score.average_precision;
        visible_classes += score.visible > 0;
    }
    scores.all.average_precision = ShareOf(scores.all.average_precision, visible_classes);
}

}  // namespace

double DetectionScore::Precision() const {
    return ShareOf(static_cast<double>(true_positives), detections);
}
double DetectionScore::Recall() const {
    return ShareOf(static_cast<double>(true_positives), visible);
}
double DetectionScore::Probability() const { return ShareOf(probability_sum, detections); }

double ObjectScore::Pt() const { return ShareOf(static_cast<double>(detected), visible); }
double ObjectScore::Pc() const { return ShareOf(static_cast<double>(right), detected); }
double ObjectScore::Probability() const { return ShareOf(probability_sum, detected); }

DetectionScores ScoreDetections(const std::vector<ScoredImage>& images,
                                const std::set<std::string>& looked_for, double min_probability) {
    DetectionScores scores;
    scores.images = static_cast<std::int64_t>(images.size());
    scores.min_probability = min_probability;
    std::map<std::string, std::vector<Candidate>> candidates;
    for (std::size_t i = 0; i < images.size(); ++i) {
        CountVisible(images[i], looked_for, scores);
        ScoreObjects(images[i], looked_for, min_probability, scores.objects);
        for (const DetectionRow& row : images[i].detections) {
            if (!looked_for.contains(row.name)) continue;
            candidates[row.name].push_back({&row, i});
            scores.least_in_file = std::min<double>(scores.least_in_file, row.probability);
        }
    }
    for (auto& [name, rows] : candidates)
        ScoreClass(images, name, std::move(rows), min_probability, scores.classes[name]);
    AddUp(scores);
    return scores;
}

}  // namespace tessera
