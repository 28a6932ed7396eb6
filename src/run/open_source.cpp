#include "run/open_source.h"

#include <filesystem>

#include "io/klg_source.h"
#include "io/openni_source.h"
#include "scan/scan_source.h"

namespace tessera {

Result<std::unique_ptr<FrameSource>> OpenSource(const std::string& name, const RunConfig& config) {
    if (name.starts_with("synthetic:")) return OpenSyntheticScene(name, config.synthetic);
    if (name.starts_with("openni2:") || name.ends_with(".oni"))
        return OpenOpenniSource(name, config.openni);
    if (name.ends_with(".scan")) return ScanSource::Open(name);
    if (name.ends_with(".klg")) return OpenKlgSource(name, config.source);
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored))
        return Status::Error(name +
                             ": no such folder (a source is a folder, FILE.oni, FILE.klg, "
                             "FILE.scan, openni2: or synthetic:NAME)");
    if (!std::filesystem::is_directory(name, ignored))
        return Status::Error(name +
                             ": is a file; a source is a folder, FILE.oni, FILE.klg, FILE.scan, "
                             "openni2: or synthetic:NAME");
    return OpenFolderSource(name, config.source);
}

}  // namespace tessera
