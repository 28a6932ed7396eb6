#include "cuda/device_residuals.h"

#include "cuda/device_loops.h"

namespace tessera::TESSERA_DEVICE {

namespace residual_bodies {

// Per part of a group.
template <class Kind>
struct SumPart {
    ResidualArguments arguments;
    double* parts;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int of_group = Kind::Parts(arguments);
        double sums[Kind::kSums] = {};
        Kind::Add(arguments, i / of_group, i % of_group, sums);
        for (int k = 0; k < Kind::kSums; ++k) parts[i * Kind::kSums + k] = sums[k];
    }
};

// Per sum of a group: adds its parts in order.
struct AddParts {
    const double* parts;
    int of_group, sums_of_part;
    double* sums;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const double* part = parts + i / sums_of_part * of_group * sums_of_part + i % sums_of_part;
        double sum = 0;
        for (int k = 0; k < of_group; ++k) sum += part[k * sums_of_part];
        sums[i] = sum;
    }
};

// Per patch, per patch, and per span of a patch's points in a row.
struct SumPatch {
    ShadingArguments arguments;
    TESSERA_HD_MEMBER void operator()(int i) const { ShadingKernels::SumPatch(arguments, i); }
};
struct MeanAround {
    ShadingArguments arguments;
    TESSERA_HD_MEMBER void operator()(int i) const { ShadingKernels::MeanAround(arguments, i); }
};
struct AddShading {
    ShadingArguments arguments;
    TESSERA_HD_MEMBER void operator()(int i) const { ShadingKernels::AddShading(arguments, i); }
};

template <class Kind>
std::size_t PartRoom(const ResidualArguments& a) {
    return static_cast<std::size_t>(Kind::Groups(a)) *
           static_cast<std::size_t>(Kind::Parts(a) * Kind::kSums);
}

}  // namespace residual_bodies

DeviceResiduals::DeviceResiduals(DeviceMemory& memory, Stream& stream)
    : stream_(stream), parts_(memory), sums_(memory), patches_(memory) {}

bool DeviceResiduals::Reserve(int width, int height) {
    using residual_bodies::PartRoom;
    ResidualArguments a{};
    a.width = width;
    a.height = height;
    const std::size_t room =
        std::max({PartRoom<DistanceSums>(a), PartRoom<ScoreSums>(a), PartRoom<ShutterSums>(a)});
    ShadingArguments shading{};
    shading.width = width;
    shading.height = height;
    return parts_.ReserveScratch(stream_, room) && sums_.ReserveScratch(stream_, room) &&
           patches_.ReserveScratch(stream_, 3 * static_cast<std::size_t>(shading.Patches()));
}

template <class Kind>
void DeviceResiduals::Sum(const ResidualArguments& a, std::vector<double>& sums) {
    const int groups = Kind::Groups(a), parts = Kind::Parts(a);
    ForEach(stream_, groups * parts, residual_bodies::SumPart<Kind>{a, parts_.data()});
    ForEach(stream_, groups * Kind::kSums,
            residual_bodies::AddParts{parts_.data(), parts, Kind::kSums, sums_.data()});
    sums.resize(static_cast<std::size_t>(groups * Kind::kSums));
    stream_.Download(sums.data(), sums_.data(), sums.size() * sizeof(double));
}

void DeviceResiduals::RemoveShading(ShadingArguments a) {
    a.sum = patches_.data();
    a.count = a.sum + a.Patches();
    a.mean = a.count + a.Patches();
    ForEach(stream_, a.Patches(), residual_bodies::SumPatch{a});
    ForEach(stream_, a.Patches(), residual_bodies::MeanAround{a});
    ForEach(stream_, a.Spans(), residual_bodies::AddShading{a});
}

template void DeviceResiduals::Sum<DistanceSums>(const ResidualArguments&, std::vector<double>&);
template void DeviceResiduals::Sum<ScoreSums>(const ResidualArguments&, std::vector<double>&);
template void DeviceResiduals::Sum<ShutterSums>(const ResidualArguments&, std::vector<double>&);

}  // namespace tessera::TESSERA_DEVICE
