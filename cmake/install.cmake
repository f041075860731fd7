# The program, the library with its header, and the walkthrough, where find_package(skybake) and the program look for them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS skybake_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS skybake EXPORT skybakeTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/skybake DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY viewer/dist/ DESTINATION share/skybake/viewer)
install(DIRECTORY rules/ DESTINATION share/skybake/rules)
install(EXPORT skybakeTargets NAMESPACE skybake:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/skybake)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/skybakeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
# The library links all of its parts privately: who uses it needs no other package.
file(WRITE ${PROJECT_BINARY_DIR}/skybakeConfig.cmake "include(\"\${CMAKE_CURRENT_LIST_DIR}/skybakeTargets.cmake\")\n")
install(FILES ${PROJECT_BINARY_DIR}/skybakeConfig.cmake ${PROJECT_BINARY_DIR}/skybakeConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/skybake)
