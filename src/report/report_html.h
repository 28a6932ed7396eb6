// The page of a finished run: one HTML file that loads nothing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "report/report_data.h"

namespace tessera {

// Same data, same bytes. Takes the mesh out of `data`. Thread-safe.
std::string ReportHtml(ReportData data, const ReportOptions& options);

// ReadReportData, ReportHtml and the file, which appears as a whole or not at all.
struct WrittenReport {
    std::size_t bytes = 0;
    std::vector<std::string> left_out, damaged;  // as in ReportData
};
Result<WrittenReport> WriteReport(const std::string& folder, const std::string& path,
                                  const ReportOptions& options);

// A file of src/report/page, compiled into the program: "page.html", "page.css", ... Another name
// is a bug.
std::string_view PageAsset(std::string_view name);

}  // namespace tessera
