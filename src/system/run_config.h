// Every setting of a run, described once for the configuration file, --set, run.json and
// docs/configuration.md.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "io/folder_source.h"
#include "io/frame_recorder.h"
#include "io/openni_config.h"
#include "mapping/mesher.h"
#include "optimize/loop_config.h"
#include "semantics/label_config.h"
#include "synth/synthetic_source.h"
#include "system/pipeline_config.h"

namespace tessera {

// For --scan and --resume.
struct ScanConfig {
    enum class Frames { kLoops, kAll };

    double interval_s = 0.5;
    Frames frames = Frames::kLoops;

    void Describe(ConfigParameters& parameters);
};

// For --mode live.
struct LiveConfig {
    int queue_frames = 2;
    int mesh_blocks = 600;
    double playback_speed = 1;
    double extra_tracking_ms = 0, extra_mapping_ms = 0;

    void Describe(ConfigParameters& parameters);
};

// For --view.
struct ViewConfig {
    int width = 1280, height = 720;
    bool close_at_end = false;

    void Describe(ConfigParameters& parameters);
};

struct RunConfig {
    FolderSourceConfig source;
    OpenniConfig openni;
    RecordConfig record;
    SynthConfig synthetic;
    PipelineConfig pipeline;
    MeshConfig meshing;
    LabelConfig labels;
    LoopConfig loops;
    ScanConfig scan;
    LiveConfig live;
    ViewConfig view;
    bool check_camera = true;    // key calibration.check
    int threads = 0;             // 0: one per core
    int read_ahead = 4;          // frames decoded ahead
    double memory_limit_mb = 0;  // of the whole process; 0: what the machine gives

    // Sections source (with source.openni), synthetic, frame, mapping, tracking, moving, meshing,
    // labels, loops, calibration, scan, live, view, record, run.
    void Describe(ConfigParameters& parameters);
    // `loops`, with what follows from other sections.
    LoopConfig EffectiveLoops() const;
    // Checks conditions between keys. The error names the key.
    Status Validate() const;
};

// A built-in configuration (config/*.yaml).
struct Preset {
    std::string name;
    std::string yaml;
};
const std::vector<Preset>& Presets();

// Loads the preset of this name, else the YAML file at this path. An error changes nothing.
Status LoadPresetOrFile(const std::string& name_or_path, ConfigParameters& parameters);

// The text of docs/configuration.md.
std::string ConfigurationDocument();

}  // namespace tessera
