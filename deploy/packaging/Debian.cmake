# `cpack` makes quorient_*.deb and quorient-dev_*.deb.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Quorient")
set(CPACK_PACKAGE_CONTACT "Quorient maintainers <maintainers@quorient.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL quorient quorient-dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# Packages of one source depend on other libraries on each release. The later release's has the larger version, and so replaces the other.
file(STRINGS /etc/os-release debian_release REGEX "^VERSION_ID=")
string(REGEX REPLACE "[^0-9]" "" debian_release "${debian_release}")
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}+deb${debian_release})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_QUORIENT_PACKAGE_NAME quorient)
set(CPACK_DEBIAN_QUORIENT_PACKAGE_SECTION science)
set(CPACK_DEBIAN_QUORIENT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_QUORIENT_PACKAGE_RECOMMENDS "libjs-dygraphs")
set(CPACK_DEBIAN_QUORIENT_PACKAGE_SUGGESTS "iceoryx, tshark, prometheus")
set(CPACK_COMPONENT_QUORIENT_DESCRIPTION "Independent processes isolate failed gyros, integrate the attitude without
them and vote on the result, so that one right attitude keeps flowing while
sensors, processes and networks fail. Speaks Fast DDS and Cyclone DDS.")
set(maintainer_scripts postinst prerm postrm)
list(TRANSFORM maintainer_scripts PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/packaging/)
set(CPACK_DEBIAN_QUORIENT_PACKAGE_CONTROL_EXTRA ${maintainer_scripts})

set(CPACK_DEBIAN_QUORIENT-DEV_PACKAGE_NAME quorient-dev)
set(CPACK_DEBIAN_QUORIENT-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_QUORIENT-DEV_PACKAGE_DEPENDS "libeigen3-dev, libexpected-dev, libfmt-dev, libboost-dev, liblz4-dev, libsqlite3-dev, libzstd-dev, zlib1g-dev, pkgconf, cmake")
set(CPACK_COMPONENT_QUORIENT-DEV_DESCRIPTION "For development: static libraries, headers and CMake configuration for sensor
geometry, fault detection and isolation, attitude integration, voting,
simulation and recordings, and the IDL file of the DDS topics.")

include(CPack)
