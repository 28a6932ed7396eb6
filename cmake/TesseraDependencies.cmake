# All dependencies are Debian 12 packages (scripts/packages.txt lists them). Nothing is downloaded.
# The core's dependencies are required. For an optional one that is missing, a message says what is
# off. Also installed: find_package(Tessera) searches for the same.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.5 REQUIRED COMPONENTS core imgproc imgcodecs calib3d features2d aruco)
find_package(OpenCV 4.5 QUIET OPTIONAL_COMPONENTS dnn)
if(TARGET opencv_dnn)
    set(TESSERA_DNN ON)
else()
    set(TESSERA_DNN OFF)
    message(STATUS "tessera: detection networks off (install libopencv-dnn-dev); detections files still work")
endif()
find_package(TBB REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(xsimd REQUIRED)
find_package(embree 3 REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(Threads REQUIRED)
find_package(JPEG REQUIRED)
find_path(DEFLATE_INCLUDE libdeflate.h REQUIRED)
find_library(DEFLATE_LIBRARY deflate REQUIRED)
find_path(READERWRITERQUEUE_INCLUDE readerwriterqueue/readerwriterqueue.h REQUIRED)
find_path(CONCURRENTQUEUE_INCLUDE concurrentqueue/concurrentqueue.h REQUIRED)

# OpenGL without a window. epoxy loads EGL and OpenGL at run time, so the build needs only the
# headers of epoxy and EGL.
find_package(PkgConfig)
if(PkgConfig_FOUND)
    pkg_check_modules(EPOXY IMPORTED_TARGET epoxy>=1.5)
    pkg_check_modules(EGL IMPORTED_TARGET egl)
endif()
if(EPOXY_FOUND AND EGL_FOUND)
    set(TESSERA_GL ON)
else()
    set(TESSERA_GL OFF)
    message(STATUS "tessera: rasterised predictions off (install pkg-config and libepoxy-dev)")
endif()

# Depth cameras (Kinect, Xtion) and .oni recordings.
find_path(OPENNI2_INCLUDE OpenNI.h PATH_SUFFIXES openni2)
find_library(OPENNI2_LIBRARY OpenNI2)
if(TESSERA_SANITIZE MATCHES thread)
    # On loading, the library unlocks a mutex that it does not hold, so ThreadSanitizer cannot check
    # any program that links it.
    set(TESSERA_OPENNI2 OFF)
elseif(OPENNI2_INCLUDE AND OPENNI2_LIBRARY)
    set(TESSERA_OPENNI2 ON)
else()
    set(TESSERA_OPENNI2 OFF)
    message(STATUS "tessera: OpenNI2 cameras and .oni recordings off (install libopenni2-dev)")
endif()

# Fewer triangles for finished models.
find_package(meshoptimizer QUIET CONFIG)
if(meshoptimizer_FOUND)
    set(TESSERA_DECIMATION ON)
else()
    set(TESSERA_DECIMATION OFF)
    message(STATUS "tessera: decimation of finished models off (install libmeshoptimizer-dev)")
endif()

# The pose graph. Ceres' package file searches for its own build dependencies, so it may fail
# although Ceres is installed.
find_package(Ceres 2.1 QUIET)
if(Ceres_FOUND)
    set(TESSERA_CERES ON)
else()
    set(TESSERA_CERES OFF)
    message(STATUS "tessera: loop closure off (install libceres-dev)")
endif()

# Scan files.
if(PkgConfig_FOUND)
    pkg_check_modules(SQLITE IMPORTED_TARGET sqlite3>=3.34)
    pkg_check_modules(ZSTD IMPORTED_TARGET libzstd>=1.4)
endif()
if(SQLITE_FOUND AND ZSTD_FOUND)
    set(TESSERA_SCAN ON)
else()
    set(TESSERA_SCAN OFF)
    message(STATUS "tessera: scan files off (install pkg-config, libsqlite3-dev and libzstd-dev)")
endif()

# Recordings of other programs: ROS bags, phones, Azure Kinect, ScanNet.
find_package(OpenCV 4.5 QUIET OPTIONAL_COMPONENTS videoio)
find_package(BZip2 QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(LZ4 IMPORTED_TARGET liblz4)
    pkg_check_modules(ZIP IMPORTED_TARGET libzip)
endif()
if(SQLITE_FOUND AND ZSTD_FOUND AND LZ4_FOUND AND ZIP_FOUND AND BZIP2_FOUND AND TARGET opencv_videoio)
    set(TESSERA_RECORDINGS ON)
else()
    set(TESSERA_RECORDINGS OFF)
    message(STATUS "tessera: recordings of ROS, RealSense, Azure Kinect and phones off (install libsqlite3-dev, "
        "libzstd-dev, liblz4-dev, libbz2-dev and libzip-dev)")
endif()
