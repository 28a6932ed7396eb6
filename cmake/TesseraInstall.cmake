# cmake --install, find_package(Tessera), and Debian packages (cpack). The last file of the build.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(documents ${CMAKE_INSTALL_DATAROOTDIR}/doc/tessera)

# The program: with its manual page and completion, made by the program itself.
set(made ${CMAKE_BINARY_DIR}/installed)
add_custom_command(OUTPUT ${made}/tessera.1 ${made}/tessera.bash
    COMMAND ${CMAKE_COMMAND} -E make_directory ${made}
    COMMAND tessera help --manual > ${made}/tessera.1
    COMMAND tessera help --completion > ${made}/tessera.bash
    DEPENDS tessera VERBATIM)
add_custom_target(tessera_manual ALL DEPENDS ${made}/tessera.1 ${made}/tessera.bash)
install(TARGETS tessera RUNTIME COMPONENT program)
install(FILES ${made}/tessera.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${made}/tessera.bash DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions
    RENAME tessera COMPONENT program)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${documents} COMPONENT program)
# The pages lie beside README.md as in the sources: it and the program's messages name them docs/PAGE.md.
install(DIRECTORY docs DESTINATION ${documents} COMPONENT program
    FILES_MATCHING PATTERN "*.md" PATTERN "images" EXCLUDE)
install(PROGRAMS python/examples/realsense.py python/examples/azure_kinect.py python/examples/orbbec.py
    python/examples/oak.py python/examples/opencv_capture.py python/examples/ros2_topics.py
    DESTINATION ${documents}/examples COMPONENT program)
install(FILES python/examples/stream.py DESTINATION ${documents}/examples COMPONENT program)

# The Kinect's driver, in the folder where Debian's OpenNI2 looks for drivers if the prefix is /usr.
if(TESSERA_KINECT)
    install(TARGETS tessera_kinect LIBRARY DESTINATION lib/${CMAKE_LIBRARY_ARCHITECTURE}/OpenNI2/Drivers COMPONENT program)
endif()

# The Python package, where Debian's interpreter finds it.
if(TESSERA_PYTHON)
    install(TARGETS tessera_python LIBRARY DESTINATION lib/python3/dist-packages/tessera COMPONENT python)
    install(FILES python/tessera/__init__.py python/tessera/__init__.pyi python/tessera/live.py python/tessera/py.typed
        python/examples/stream.py DESTINATION lib/python3/dist-packages/tessera COMPONENT python)
endif()

# The libraries, for find_package(Tessera).
get_property(libraries GLOBAL PROPERTY TESSERA_LIBRARIES)
list(REMOVE_ITEM libraries tessera_viz tessera_vdb)  # of the program alone
install(TARGETS ${libraries} tessera_options EXPORT TesseraTargets ARCHIVE COMPONENT development)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Tessera)
install(EXPORT TesseraTargets NAMESPACE Tessera:: DESTINATION ${package} COMPONENT development)
configure_package_config_file(cmake/TesseraConfig.cmake.in ${CMAKE_BINARY_DIR}/TesseraConfig.cmake
    INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/TesseraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/TesseraConfig.cmake ${CMAKE_BINARY_DIR}/TesseraConfigVersion.cmake
    cmake/TesseraDependencies.cmake DESTINATION ${package} COMPONENT development)
foreach(folder core io recordings mapping synth render tracking semantics eval optimize finish report scan export plan system run)
    install(DIRECTORY src/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tessera COMPONENT development
        FILES_MATCHING PATTERN "*.h" PATTERN "page" EXCLUDE)
endforeach()
install(DIRECTORY tests/install/consumer DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libtessera-dev/examples
    COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tessera)
set(CPACK_PACKAGE_CONTACT "The Tessera authors <tessera@localhost>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)  # archives refuse zstd
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/TesseraDebian.cmake)
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
if(TESSERA_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Each description: a line of summary, then the text.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tessera)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libegl1, libgl1, libgl1-mesa-dri, fonts-dejavu-core")  # opened by name
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-tessera, python3-numpy")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "dense RGB-D SLAM: a camera's path and a coloured mesh
From a depth camera, live or recorded, Tessera computes the camera's path
and a coloured mesh. It needs no GPU and no network. It shows the scan in a
window, finishes models with textures, and exports meshes, point clouds,
floor plans and maps for robots.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtessera-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "dense RGB-D SLAM: static libraries and headers
The libraries that the program tessera is made of, for CMake's
find_package(Tessera). Headers may change with every minor version.")
# What TesseraDependencies.cmake searches for: the list without TesseraProgramDependencies.cmake, tests and sanitizers.
file(STRINGS scripts/packages.txt lines REGEX "^(lib.*-dev|nlohmann-json3-dev|pkg-config)$")
list(REMOVE_ITEM lines libgtest-dev libbenchmark-dev libxtst-dev libtinygltf-dev liboctomap-dev libclang-rt-14-dev
    libcli11-dev libspdlog-dev libfreenect-dev libimgui-dev libglfw3-dev libopenvdb-dev)
list(JOIN lines ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
if(TESSERA_PYTHON)
    # The module is built for one minor version of Python.
    math(EXPR next "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tessera)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/cmake/debian/postinst
        ${CMAKE_SOURCE_DIR}/cmake/debian/prerm)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
    set(CPACK_DEBIAN_PYTHON_DESCRIPTION "dense RGB-D SLAM: Python module
Scans frame by frame from NumPy arrays, reads recordings and results, and
measures errors. It runs the engine of the program tessera.")
endif()
include(CPack)
