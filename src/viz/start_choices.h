// What a person chooses on the start screen, and the command line that does it. Plain values.
#pragma once

#include <string>
#include <vector>

namespace tessera {

enum class StartPage { kFiles, kCamera, kDemo };
enum class StartQuality { kFast, kNormal, kFine };

struct StartChoices {
    StartPage page = StartPage::kFiles;
    std::string path;            // kFiles: as typed or chosen
    std::string camera;          // kCamera: URI of the device
    std::string scene = "desk";  // kDemo
    StartQuality quality = StartQuality::kNormal;
    bool loops = true;
    std::string labels;         // a detection network; empty: none
    std::string output_folder;  // of the run

    bool operator==(const StartChoices&) const = default;
};

// Voxel size and truncation of a quality, with what it costs.
struct QualityInfo {
    StartQuality quality;
    const char *name, *label, *voxel_size_m, *truncation_m, *cost;
};
const std::vector<QualityInfo>& StartQualities();
const QualityInfo& InfoOf(StartQuality quality);

// A built-in scene to try, in a few words.
struct DemoScene {
    const char *name, *text;
};
const std::vector<DemoScene>& DemoScenes();

// The argument SOURCE of the run, or PATH of what is shown, with the home folder for "~"; empty:
// nothing is chosen yet.
std::string SourceOf(const StartChoices& choices);
// The argument DIR of the run, in the same way.
std::string OutputFolderOf(const StartChoices& choices);
// The words of "tessera run SOURCE --out DIR --view ...": a setting that is the program's default
// is left out.
std::vector<std::string> RunWords(const StartChoices& choices);
// The words of "tessera view PATH".
std::vector<std::string> ViewWords(const StartChoices& choices);

// "scan-20240131-235959" of now, or with "-2" and so on, so that nothing of this name is in the
// current folder.
std::string NewOutputFolder();

}  // namespace tessera
