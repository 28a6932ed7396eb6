#include "finish/finish_report.h"

#include <nlohmann/json.hpp>

namespace tessera {

std::string FinishReportJson(const FinishReport& r) {
    using nlohmann::json;
    json file = json::object(), levels = json::array();
    file["triangles_before"] = r.triangles_before;
    file["evidence_frames"] = r.evidence_frames;
    file["flaps"] = json::object({{"seen_through_triangles", r.flaps.triangles},
                                  {"fringe_triangles", r.flaps.fringe},
                                  {"area_m2", r.flaps.area_m2}});
    file["islands"] = json::object({{"islands", r.islands.islands},
                                    {"triangles", r.islands.triangles},
                                    {"area_m2", r.islands.area_m2}});
    const ClosedHoles& h = r.holes;
    file["holes"] = json::object({{"loops", h.loops},
                                  {"outer", h.outer},
                                  {"larger", h.large},
                                  {"uneven", h.uneven},
                                  {"folded", h.folded},
                                  {"seen_through", h.through},
                                  {"closed", h.closed},
                                  {"border_m", h.border_m},
                                  {"hole_border_m", h.hole_border_m},
                                  {"closed_border_m", h.closed_border_m},
                                  {"area_m2", h.area_m2},
                                  {"triangles", h.triangles}});
    file["frames"] = r.frames;
    file["views"] = r.views;
    for (const LevelReport& l : r.levels)
        levels.push_back(json::object({{"triangles", l.triangles},
                                       {"error_m", l.error_m},
                                       {"charts", l.charts},
                                       {"texture", json::array({l.width, l.height})},
                                       {"texel_m", l.texel_m},
                                       {"seen_share", l.seen_share}}));
    file["levels"] = levels;
    return file.dump(2) + "\n";
}

}  // namespace tessera
