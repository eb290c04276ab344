# Run by cpack on the installed files before it packs them: what Debian's policy wants of a package, and an installation does not need.
foreach(tool dpkg-shlibdeps file)  # without them CPack would leave out the dependencies
  find_program(found_${tool} ${tool})
  if(NOT found_${tool})
    message(FATAL_ERROR "${tool} is missing: apt-get install dpkg-dev file")
  endif()
endforeach()

# Libraries that are compiled into the programs, whose licences ask for their notices; the packages of others bring their own.
set(compiled_in fonts-dejavu-core libcli11-dev libglm-dev libimgui-dev libvulkan-volk-dev nlohmann-json3-dev pybind11-dev)
set(notices ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/freevoxels/usr/share/doc/freevoxels/third_party_notes)
foreach(library IN LISTS compiled_in)
  file(COPY_FILE /usr/share/doc/${library}/copyright ${notices}/${library}.copyright)
endforeach()

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(GLOB packages ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(package IN LISTS packages)  # one folder for each
  cmake_path(GET package FILENAME name)
  string(REPLACE _ - name ${name})
  set(doc ${package}/usr/share/doc/${name})
  file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${doc})
  file(REMOVE ${doc}/LICENSE)  # /usr/share/common-licenses has it, and the copyright names it
  file(WRITE ${doc}/changelog
"${name} (${CPACK_DEBIAN_PACKAGE_VERSION}) unstable; urgency=medium

  * The changes are in /usr/share/doc/freevoxels/apps/manual/changelog.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
  file(GLOB pages ${package}/usr/share/man/man1/*.1)
  execute_process(COMMAND gzip -9nf ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/lintian_overrides
               ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/freevoxels/usr/share/lintian/overrides/freevoxels COPYONLY)
