// The parts of the page that are text: key figures, objects, settings, how to make the run again.
// Each is HTML, or empty if the run does not have it. Pure functions, thread-safe.
#pragma once

#include <cstddef>
#include <string>

#include "report/report_data.h"

namespace tessera {

std::string SubtitleHtml(const ReportData& data);
// `shown` is the model on the page, which may have fewer than `triangles`, or than `points` if the
// model has no triangles.
std::string TilesHtml(const ReportData& data, const TriangleMesh& shown, std::size_t points,
                      std::size_t triangles);
std::string ObjectsSection(const ReportData& data);
std::string SettingsSection(const ReportData& data, const ReportOptions& options);
std::string AgainSection(const ReportData& data, const ReportOptions& options);
std::string DamageSection(const ReportData& data);
std::string LeftOutSection(const ReportData& data);

// Settings of the run whose value is not the default, with both; numbers are compared as numbers.
struct ChangedSetting {
    std::string key, value, default_value;  // with units
};
std::vector<ChangedSetting> ChangedSettings(const RunRecord& record,
                                            const std::vector<KnownSetting>& known);

}  // namespace tessera
