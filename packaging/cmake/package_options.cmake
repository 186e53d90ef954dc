# Read by cpack for each kind of package.

# The date of all files in it is that of the release: two builds of one commit, in any two folders,
# make the same package.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(COMMAND date --utc --date ${CPACK_TREPHINE_RELEASED} +%s
                  OUTPUT_VARIABLE released OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(ENV{SOURCE_DATE_EPOCH} ${released})
endif()
# Of one build: what it measures with is not told by a version of its own.
set(CPACK_DEBIAN_RESEARCHER_PACKAGE_DEPENDS "trephine (= ${CPACK_PACKAGE_VERSION})")
if(CPACK_GENERATOR STREQUAL "TGZ")
  set(CPACK_PACKAGE_FILE_NAME "trephine-${CPACK_PACKAGE_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR}")
endif()
