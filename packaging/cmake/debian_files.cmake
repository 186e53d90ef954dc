# The .deb's files that lie outside of the prefix, or are named as Debian names them.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  # cpack dates the files of a .deb alone.
  execute_process(COMMAND find ${CPACK_TEMPORARY_DIRECTORY} -exec touch --no-dereference
                          --date @$ENV{SOURCE_DATE_EPOCH} {} + COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()
set(root ${CPACK_TEMPORARY_DIRECTORY})
file(MAKE_DIRECTORY ${root}/etc/trephine ${root}/etc/security/limits.d)
configure_file(${CPACK_TREPHINE_DEBIAN}/limits.conf ${root}/etc/security/limits.d/60-trephine.conf
               COPYONLY)
configure_file(${CPACK_TREPHINE_DEBIAN}/lintian-overrides
               ${root}/usr/share/lintian/overrides/trephine COPYONLY)
execute_process(COMMAND date --utc --rfc-email --date ${CPACK_TREPHINE_RELEASED}
                OUTPUT_VARIABLE TREPHINE_RELEASED_RFC OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
set(changelog ${root}/usr/share/doc/trephine/changelog)
configure_file(${CPACK_TREPHINE_DEBIAN}/changelog.in ${changelog} @ONLY)
execute_process(COMMAND gzip --no-name --best ${changelog} COMMAND_ERROR_IS_FATAL ANY)
