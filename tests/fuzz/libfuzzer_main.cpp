// The entry of libFuzzer. The environment variable TESSERA_FUZZ names the target; without it the
// targets are listed. The target's seeds are first written to the folder TESSERA_FUZZ_SEEDS.
// scripts/fuzz sets both.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "fuzz/fuzz_target.h"

namespace {

tessera::fuzz::FuzzTarget chosen;

void Choose() {
    const char* name = std::getenv("TESSERA_FUZZ");
    if (name == nullptr) {
        for (const tessera::fuzz::FuzzTarget& target : tessera::fuzz::FuzzTargets())
            std::puts(target.name.c_str());
        std::exit(0);
    }
    for (tessera::fuzz::FuzzTarget& target : tessera::fuzz::FuzzTargets())
        if (target.name == name) chosen = target;
    TESSERA_CHECK(chosen.run, "TESSERA_FUZZ: no such target");
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    Choose();
    if (const char* folder = std::getenv("TESSERA_FUZZ_SEEDS")) {
        int number = 0;
        for (const tessera::fuzz::Bytes& seed : chosen.seeds())
            std::ofstream(std::filesystem::path(folder) / ("seed" + std::to_string(number++)),
                          std::ios::binary)
                .write(reinterpret_cast<const char*>(seed.data()), std::ssize(seed));
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    chosen.run({data, size});
    return 0;
}
