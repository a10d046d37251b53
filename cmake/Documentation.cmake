# What stands beside the model in the FMU: index.html, fmi-ls-ref.html, the licences, the icon, and the folder of related files.
# Gives documentation_arguments for tools.packing.archive, and documentation_files that they depend on.

set(documentation_page "${CMAKE_BINARY_DIR}/generated/index.html")
file(GLOB documentation_parts CONFIGURE_DEPENDS docs/fmu/*.html docs/fmu/*.svg)
add_custom_command(
    OUTPUT "${documentation_page}"
    COMMAND Python3::Interpreter -B -m tools.packing.documentation "${documentation_page}"
    DEPENDS "${model_description}" ${documentation_parts} tools/packing/documentation.py tools/description.py
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
    COMMENT "Writing the documentation"
    VERBATIM)

# Parameter sets, experiments and their reference results (layered standard FMI-LS-REF), what connects to what, and pages.
file(GLOB related_files CONFIGURE_DEPENDS data/related/*)
set(documentation_arguments
    --folder "extra/org.fmi-standard.fmi-ls-ref=data/related"
    --file "documentation/index.html=${documentation_page}"
    --file documentation/fmi-ls-ref.html=docs/fmu/related.html
    --file terminalsAndIcons/terminalsAndIcons.xml=docs/fmu/terminalsAndIcons.xml
    --file model.png=docs/fmu/model.png
    --file documentation/licenses/license.txt=LICENSE)
if(WITH_SUNDIALS)
    list(APPEND documentation_arguments
        --file documentation/licenses/sundials-license.txt=docs/fmu/licenses/sundials-license.txt
        --file documentation/licenses/sundials-notice.txt=docs/fmu/licenses/sundials-notice.txt)
endif()
file(GLOB documentation_licenses CONFIGURE_DEPENDS docs/fmu/licenses/*.txt)
set(documentation_files
    "${documentation_page}" ${related_files} docs/fmu/related.html docs/fmu/terminalsAndIcons.xml docs/fmu/model.png
    LICENSE ${documentation_licenses})
