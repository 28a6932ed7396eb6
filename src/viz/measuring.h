// The measuring tool: what clicks on the surface add up to, and the file that keeps it. Owner
// thread only.
#pragma once

#include <cstdint>
#include <string>

#include "viz/measurement.h"

namespace tessera {

class Measuring {
  public:
    // `file`: where measurements are kept, and read from if it exists; empty: nowhere. A file that
    // cannot be read is left alone, and nothing is saved; `trouble` says why.
    void Open(const std::string& file);

    bool on() const { return on_; }
    void Toggle();
    // A click on the surface: the next corner; on the first corner (`on_first`), the line becomes a
    // polygon. `raise`: if the last measurement is a polygon, its body ends at this height.
    void Click(const Eigen::Vector3d& p_world, bool on_first, bool raise);
    // Takes the last click back, of whichever measurement is the last one. After Clear, until the
    // next click: brings all of them back.
    void TakeBack();
    // The next click begins another measurement.
    void Finish();
    void Clear();  // ends the line, and takes all away

    const std::vector<Measurement>& all() const { return all_; }
    // The one that the next click goes on with; null: it begins another.
    const Measurement* open() const { return is_open_ ? &all_.back() : nullptr; }
    std::uint64_t changes() const { return changes_; }       // so far
    const std::string& trouble() const { return trouble_; }  // one line; empty: none

  private:
    void Changed();

    std::vector<Measurement> all_, cleared_;
    bool on_ = false, is_open_ = false, may_save_ = false;
    std::uint64_t changes_ = 0;
    std::string file_, trouble_;
};

// For a run's folder, which may not be there yet, "FOLDER/measurements.json"; for a file NAME.ply
// or NAME.scan "NAME.measurements.json" beside it.
std::string MeasurementsFile(const std::string& shown);

}  // namespace tessera
