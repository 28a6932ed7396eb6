#include "cuda/device_surface.h"

#include "cuda/surface_kernels.h"

namespace tessera::TESSERA_DEVICE {

DeviceSurface::DeviceSurface(DeviceMemory& memory, Stream& stream)
    : stream_(stream),
      sums_(memory),
      cases_(memory),
      ids_(memory),
      reads_(memory),
      rows_(memory),
      aprons_(memory),
      vertex_count_(memory),
      triangle_count_(memory),
      vertex_first_(memory),
      triangle_first_(memory),
      first_(memory),
      vertices_(memory),
      triangles_(memory) {}

bool DeviceSurface::Reserve(std::size_t blocks) {
    if (cases_.capacity() == 0) {
        if (!cases_.Reserve(stream_, kCubeConfigurations, 0)) return false;
        stream_.Upload(cases_.data(), CubeCases().data(), sizeof CubeCases());
    }
    return ids_.ReserveScratch(stream_, blocks) &&
           reads_.ReserveScratch(stream_, blocks * kBlocksAround) &&
           rows_.ReserveScratch(stream_, blocks * CellRows::kRows) &&
           aprons_.ReserveScratch(stream_, blocks * ApronField::kWords) &&
           vertex_count_.ReserveScratch(stream_, blocks * kEdgeRows + 1) &&
           vertex_first_.ReserveScratch(stream_, blocks * kEdgeRows + 1) &&
           triangle_count_.ReserveScratch(stream_, blocks * kCellRows + 1) &&
           triangle_first_.ReserveScratch(stream_, blocks * kCellRows + 1) &&
           first_.ReserveScratch(stream_, blocks + 1);
}

// Fills the buffers that Extract reads, up to first_.
bool DeviceSurface::Count(const DeviceMapView& map, int count, const CellLimits& limits) {
    const int edge_rows = count * kEdgeRows, cell_rows = count * kCellRows;
    ForEach(stream_, count * CellRows::kRows, ReadCellRows{map, ids_.data(), limits, rows_.data()});
    ForEach(
        stream_, cell_rows,
        CountSurface{rows_.data(), cases_.data(), vertex_count_.data(), triangle_count_.data()});
    // With a zero at the end, the last prefix sums are the ends.
    stream_.Fill(vertex_count_.data() + edge_rows, 0, sizeof(std::int32_t));
    stream_.Fill(triangle_count_.data() + cell_rows, 0, sizeof(std::int32_t));
    if (!sums_.SumBefore(stream_, vertex_count_.data(), edge_rows + 1, vertex_first_.data()) ||
        !sums_.SumBefore(stream_, triangle_count_.data(), cell_rows + 1, triangle_first_.data()))
        return false;
    ForEach(stream_, count + 1,
            TakeFirsts{vertex_first_.data(), triangle_first_.data(), first_.data()});
    return true;
}

bool DeviceSurface::Extract(const DeviceMapView& map, const std::int32_t* ids, int count,
                            const CellLimits& limits, SurfaceArrays& out) {
    const auto blocks = static_cast<std::size_t>(count);
    if (!Reserve(blocks)) return false;
    stream_.Upload(ids_.data(), ids, blocks * sizeof *ids);
    if (!Count(map, count, limits)) return false;
    out.first.resize(blocks + 1);
    stream_.Download(out.first.data(), first_.data(), out.first.size() * sizeof out.first[0]);
    stream_.Wait();
    out.vertices.resize(static_cast<std::size_t>(out.first.back().vertex));
    out.triangles.resize(static_cast<std::size_t>(out.first.back().triangle));
    if (!vertices_.ReserveScratch(stream_, out.vertices.size()) ||
        !triangles_.ReserveScratch(stream_, out.triangles.size()))
        return false;
    ForEach(stream_, count * kBlocksAround, FindReadBlocks{map, ids_.data(), reads_.data()});
    ForEach(stream_, count * ApronField::kWords,
            FillApron{map, reads_.data(), first_.data(), aprons_.data()});
    ForEach(stream_, count * kCellRows,
            EmitSurface{map, ids_.data(), rows_.data(), cases_.data(), aprons_.data(),
                        vertex_first_.data(), triangle_first_.data(), vertices_.data(),
                        triangles_.data()});
    stream_.Download(out.vertices.data(), vertices_.data(),
                     out.vertices.size() * sizeof out.vertices[0]);
    stream_.Download(out.triangles.data(), triangles_.data(),
                     out.triangles.size() * sizeof out.triangles[0]);
    stream_.Wait();
    return true;
}

}  // namespace tessera::TESSERA_DEVICE
