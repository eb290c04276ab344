# `cpack --config build/CPackConfig.cmake` makes packages, for the Debian that they are made on, of what `cmake --install build` installs:
# freevoxels, and freevoxels-mpi where Open MPI was found, so that only those who want it install MPI.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME freevoxels)
set(CPACK_PACKAGE_CONTACT "The FreeVoxels developers <freevoxels@freevoxels.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
foreach(component programs library python)
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENT_${upper}_GROUP freevoxels)
endforeach()
set(CPACK_COMPONENT_MPI_GROUP freevoxels_mpi)

# Debian's release is a part of the version: the packages of two releases are different, and the newer one replaces the older.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}+${system_ID}${system_VERSION_ID})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_FREEVOXELS_PACKAGE_NAME freevoxels)
set(CPACK_DEBIAN_FREEVOXELS_DESCRIPTION "volume renderer without sorting, for GPUs and CPUs
Draws OpenVDB files, scans and arrays: clouds, smoke, fire and CT, with
shadows, on Vulkan 1.3. Without a GPU it draws on the CPU by Mesa's lavapipe.
.
The package has the command freevoxels, the viewer freevoxels-view, the C++
library with its headers, the Python module, and the manual.")
# What Debian's policy wants of a package with a shared library. CPack's own scripts, which call ldconfig, cannot be left out.
set(control ${PROJECT_BINARY_DIR}/debian_package)
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libfreevoxels ${PROJECT_VERSION_MAJOR} freevoxels (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_FREEVOXELS_PACKAGE_CONTROL_EXTRA ${control}/triggers ${control}/shlibs)
set(CPACK_DEBIAN_FREEVOXELS_PACKAGE_DEPENDS "libvulkan1, mesa-vulkan-drivers")  # opened at run time
if(FREEVOXELS_PYTHON)  # the module is of this Python alone
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_FREEVOXELS_PACKAGE_DEPENDS ", python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~)"
                                                        ", python3 (<< ${Python_VERSION_MAJOR}.${next_minor})")
endif()
set(CPACK_DEBIAN_FREEVOXELS_PACKAGE_RECOMMENDS python3-numpy)
set(CPACK_DEBIAN_FREEVOXELS_PACKAGE_SUGGESTS freevoxels-mpi)

set(CPACK_DEBIAN_FREEVOXELS_MPI_PACKAGE_NAME freevoxels-mpi)
set(CPACK_DEBIAN_FREEVOXELS_MPI_DESCRIPTION "volume renderer without sorting, on clusters by MPI
Draws the images of freevoxels by all processes of an MPI job together, with
the same bits for any number of them.
.
The package has the command freevoxels-mpi; the package freevoxels has its
manual, and job scripts for Slurm.")
set(CPACK_DEBIAN_FREEVOXELS_MPI_PACKAGE_DEPENDS
    "freevoxels (= ${CPACK_DEBIAN_PACKAGE_VERSION}), libvulkan1, mesa-vulkan-drivers, openmpi-bin")

set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/prepare.cmake)
include(CPack)
cpack_add_component_group(freevoxels)
cpack_add_component_group(freevoxels_mpi)
