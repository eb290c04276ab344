# `cpack --config build/CPackConfig.cmake` makes a package, for the Debian that it is made on, of what `cmake --install build` installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME freevoxels)
set(CPACK_PACKAGE_CONTACT "The FreeVoxels developers <freevoxels@freevoxels.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "volume renderer without sorting, for GPUs and CPUs")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Draws OpenVDB files, scans and arrays: clouds, smoke, fire and CT, with
shadows, on Vulkan 1.3. Without a GPU it draws on the CPU by Mesa's lavapipe.
.
The package has the command freevoxels, the viewer freevoxels-view, the C++
library with its headers, the Python module, and the manual.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# CPack's own shlibs come with scripts that call ldconfig, where Debian's policy wants a trigger.
set(control ${PROJECT_BINARY_DIR}/debian_package)
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
file(WRITE ${control}/shlibs "libfreevoxels ${PROJECT_VERSION_MAJOR} freevoxels (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${control}/triggers ${control}/shlibs)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libvulkan1, mesa-vulkan-drivers")  # opened at run time
if(FREEVOXELS_PYTHON)  # the module is of this Python alone
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~)"
                                             ", python3 (<< ${Python_VERSION_MAJOR}.${next_minor})")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-numpy)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/prepare.cmake)
include(CPack)
