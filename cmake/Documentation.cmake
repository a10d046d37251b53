# The documentation inside the FMU: index.html, the licences and the icon.
# Gives documentation_arguments for cmake/package_fmu.py, and documentation_files that they depend on.

set(documentation_page "${CMAKE_BINARY_DIR}/generated/index.html")
file(GLOB documentation_parts CONFIGURE_DEPENDS docs/fmu/*.html docs/fmu/*.svg)
add_custom_command(
    OUTPUT "${documentation_page}"
    COMMAND Python3::Interpreter -B -m frictionlab.fmu_docs.page "${documentation_page}"
    DEPENDS "${model_description}" ${documentation_parts} frictionlab/fmu_docs/page.py frictionlab/project.py
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
    COMMENT "Writing the documentation"
    VERBATIM)

set(documentation_arguments
    --file "documentation/index.html=${documentation_page}"
    --file model.png=docs/fmu/model.png
    --file documentation/licenses/license.txt=LICENSE)
if(WITH_SUNDIALS)
    list(APPEND documentation_arguments
        --file documentation/licenses/sundials-license.txt=docs/fmu/licenses/sundials-license.txt
        --file documentation/licenses/sundials-notice.txt=docs/fmu/licenses/sundials-notice.txt)
endif()
file(GLOB documentation_licenses CONFIGURE_DEPENDS docs/fmu/licenses/*.txt)
set(documentation_files "${documentation_page}" docs/fmu/model.png LICENSE ${documentation_licenses})
