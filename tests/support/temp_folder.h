// A temporary folder that is deleted with its object. Tests run in parallel and must not share
// names.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace tessera {

class TempFolder {
  public:
    TempFolder() : path_(::testing::TempDir() + "tessera_XXXXXX") {
        if (mkdtemp(path_.data()) == nullptr) ADD_FAILURE() << "cannot create folder " << path_;
    }
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }

  private:
    std::string path_;
};

// One folder for the whole test program. ctest starts a new process for every test.
inline const std::string& ProcessFolder() {
    static const TempFolder folder;
    return folder.path();
}

}  // namespace tessera
