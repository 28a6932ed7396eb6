#include "system/open_source.h"

#include <filesystem>

namespace tessera {

Result<std::unique_ptr<FrameSource>> OpenSource(const std::string& name, const RunConfig& config) {
    if (name.starts_with("synthetic:")) return OpenSyntheticScene(name, config.synthetic);
    for (const char* end : {".oni", ".klg", ".scan"})
        if (name.ends_with(end))
            return Status::Error(fmt::format("{}: {} files: not in this version", name, end));
    if (name.starts_with("openni2:"))
        return Status::Error(name + ": OpenNI2 cameras: not in this version");
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored))
        return Status::Error(name + ": no such folder (a source is a folder or synthetic:NAME)");
    if (!std::filesystem::is_directory(name, ignored))
        return Status::Error(name + ": is a file; a source is a folder or synthetic:NAME");
    return OpenFolderSource(name, config.source);
}

}  // namespace tessera
