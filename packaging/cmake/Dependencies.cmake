# Every library the product uses, found once. Debian's packages only: nothing is downloaded.
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(glm REQUIRED)
find_package(DCMTK REQUIRED)
find_package(OpenJPEG REQUIRED)
find_package(ZLIB REQUIRED)

# Several Debian packages bring the MPI build of HDF5 along; recordings must use the serial one.
set(HDF5_PREFER_PARALLEL OFF)
find_package(HDF5 REQUIRED COMPONENTS C)
if(HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Found the MPI build of HDF5 in ${HDF5_INCLUDE_DIRS}. "
                      "Trephine needs the serial one: install libhdf5-dev, not libhdf5-mpi-dev.")
endif()

if(TREPHINE_WINDOW)
  find_package(MPI QUIET COMPONENTS C) # Debian's VTK targets name MPI::MPI_C
  find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel
               CommonTransforms FiltersCore FiltersSources ImagingGeneral ImagingMorphological InteractionStyle IOGeometry IOImage
               RenderingCore RenderingOpenGL2 RenderingVolume RenderingVolumeOpenGL2 vtksys)
  find_package(OpenGL REQUIRED COMPONENTS OpenGL GLX)
  find_package(X11 REQUIRED)
  find_package(OpenXR REQUIRED)
  find_package(GLEW REQUIRED)
  find_package(CLI11 REQUIRED)
  find_package(Qt6 REQUIRED COMPONENTS Gui OpenGL Widgets OpenGLWidgets)
endif()
