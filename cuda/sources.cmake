# The sources of a device besides its backend (device_cuda.cu or device_host.cpp). Included by the
# program's library and by that of the tests.
set(TESSERA_DEVICE_KERNELS  # compiled by nvcc for a GPU: loops over items
    device_map.cpp device_fusion.cpp device_pixels.cpp device_residuals.cpp device_points.cpp device_sums.cpp device_rays.cpp
    device_surface.cpp)
set(TESSERA_DEVICE_SOURCES
    device.cpp device_frame.cpp device_integrator.cpp device_views.cpp device_icp.cpp device_mesher.cpp device_pipeline.cpp)
list(TRANSFORM TESSERA_DEVICE_KERNELS PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
list(TRANSFORM TESSERA_DEVICE_SOURCES PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
