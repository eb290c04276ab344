# Run by cpack on the installed files before it packs them: what Debian's policy wants of a package, and an installation does not need.
set(doc ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/doc/freevoxels)
file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${doc})
file(REMOVE ${doc}/LICENSE)  # /usr/share/common-licenses has it, and the copyright names it

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog
"freevoxels (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * The changes are in /usr/share/doc/freevoxels/apps/manual/changelog.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
file(GLOB pages ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/man/man1/*.1)
execute_process(COMMAND gzip -9nf ${doc}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
