#include "report/report_html.h"

#include <algorithm>
#include <filesystem>

#include "io/file.h"
#include "report/mesh_clustering.h"
#include "report/page_parts.h"
#include "report/page_text.h"
#include "report/report_charts.h"
#include "report/report_sections.h"
#include "report/viewer_data.h"

namespace tessera {
namespace {

std::string Title(const ReportData& data) {
    namespace fs = std::filesystem;
    std::string name = data.record ? data.record->source_name : data.folder;
    while (name.size() > 1 && name.ends_with('/')) name.pop_back();
    const std::string last = fs::path(name).filename().string();
    return last.empty() ? name : last;
}

std::string Script() {
    std::string script = "(() => {\n'use strict';\n";
    for (const char* name : {"viewer_math.js", "viewer_model.js", "viewer_draw.js",
                             "viewer_camera.js", "viewer.js", "page.js"})
        script += PageAsset(name);
    return script + "})();\n";
}

}  // namespace

std::string ReportHtml(ReportData data, const ReportOptions& options) {
    const std::size_t points = data.mesh ? data.mesh->vertices.size() : 0,
                      triangles = data.mesh ? data.mesh->triangles.size() : 0;
    ReducedMesh model;
    if (data.mesh) model = ReduceMesh(std::move(*data.mesh), options.most_triangles);
    data.mesh.reset();
    if (model.cell_m > 0)
        data.left_out.push_back(
            fmt::format("The model has {} triangles; this page shows {}, made on a grid of {}.",
                        CountText(static_cast<std::int64_t>(triangles)),
                        CountText(static_cast<std::int64_t>(model.mesh.triangles.size())),
                        LengthText(model.cell_m)));
    if (triangles == 0 && model.mesh.vertices.size() < points)
        data.left_out.push_back(
            fmt::format("The model has {} points; this page shows {}, evenly chosen.",
                        CountText(static_cast<std::int64_t>(points)),
                        CountText(static_cast<std::int64_t>(model.mesh.vertices.size()))));
    const std::string sections =
        DamageSection(data) + std::string(PageAsset("viewer.html")) + TrackingSection(data) +
        ErrorSection(data) + TimesSection(data) + CorrectionSection(data) + ObjectsSection(data) +
        SettingsSection(data, options) + AgainSection(data, options) + LeftOutSection(data);
    return FillTemplate(PageAsset("page.html"),
                        {{"title", EscapeHtml(Title(data))},
                         {"subtitle", SubtitleHtml(data)},
                         {"tiles", TilesHtml(data, model.mesh, points, triangles)},
                         {"css", std::string(PageAsset("page.css"))},
                         {"sections", sections},
                         {"version", EscapeHtml(options.version)},
                         {"data", ViewerData(data, model.mesh)},
                         {"script", Script()}});
}

Result<WrittenReport> WriteReport(const std::string& folder, const std::string& path,
                                  const ReportOptions& options) {
    Result<ReportData> data = ReadReportData(folder, options);
    if (!data.ok()) return data.status();
    WrittenReport written{0, data.value().left_out, data.value().damaged};
    const std::string html = ReportHtml(std::move(data.value()), options);
    written.bytes = html.size();
    if (Status status = WriteTextFile(path, html); !status.ok()) return status;
    return written;
}

}  // namespace tessera
