# Run by cpack on each installed component before it is packed: what Debian wants of a package and `cmake --install`
# does not need. With SOURCE_DATE_EPOCH the same files give the same bytes.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(READ ${CPACK_RESOURCE_FILE_LICENSE} license)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]+)" line "${license}")
set(holder "${CMAKE_MATCH_1}")
string(REGEX REPLACE "^.*Copyright [^\n]*\n\n" "" license "${license}")
string(STRIP "${license}" license)
string(REPLACE "\n\n" "\n.\n" license "${license}")
string(REPLACE "\n" "\n " license "${license}")

foreach(component program development python)
    string(TOUPPER ${component} upper)
    set(folder ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}${CPACK_PACKAGING_INSTALL_PREFIX}/share)
    set(name ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
    if(NOT name OR NOT IS_DIRECTORY ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component})
        continue()
    endif()
    file(WRITE ${folder}/doc/${name}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: ${CPACK_PACKAGE_NAME}

Files: *
Copyright: ${holder}
License: Expat

License: Expat
 ${license}
")
    file(WRITE ${folder}/doc/${name}/changelog "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) UNRELEASED; urgency=medium

  * CHANGELOG.md, in the package tessera, has the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
    file(REMOVE ${folder}/doc/${name}/LICENSE)  # copyright has it
    file(GLOB pages ${folder}/man/man1/*.1)
    execute_process(COMMAND gzip -9nf ${folder}/doc/${name}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
