# What stands beside the model in the FMU: index.html, fmi-ls-ref.html, the licences, the icon, and the folder of related files.
# Gives documentation_arguments for workshop.packing.archive, and documentation_files that they depend on.

set(documentation_page "${CMAKE_BINARY_DIR}/generated/index.html")
file(GLOB documentation_parts CONFIGURE_DEPENDS docs/fmu/*.html docs/fmu/*.svg)
add_custom_command(
    OUTPUT "${documentation_page}"
    COMMAND Python3::Interpreter -B -m workshop.fmu_docs.page "${documentation_page}"
    DEPENDS "${model_description}" ${documentation_parts} workshop/fmu_docs/page.py workshop/description.py
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
    COMMENT "Writing the documentation"
    VERBATIM)

# Parameter sets, experiments and their reference results (layered standard FMI-LS-REF), and the page about them.
set(related_folder "${CMAKE_BINARY_DIR}/generated/org.fmi-standard.fmi-ls-ref")
set(related_manifest "${related_folder}/fmi-ls-manifest.xml")
set(related_page "${CMAKE_BINARY_DIR}/generated/fmi-ls-ref.html")
file(GLOB related_parts CONFIGURE_DEPENDS workshop/related/*.py data/related/*.csv docs/fmu/related.html)
add_custom_command(
    OUTPUT "${related_manifest}" "${related_page}"
    COMMAND Python3::Interpreter -B -m workshop.related.files "${related_folder}"
    COMMAND Python3::Interpreter -B -m workshop.related.page "${related_page}"
    DEPENDS "${model_description}" ${related_parts} workshop/presets.py frictioncontact/parameters.py
            workshop/description.py
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
    COMMENT "Writing the related files"
    VERBATIM)

set(documentation_arguments
    --folder "extra/org.fmi-standard.fmi-ls-ref=${related_folder}"
    --file "documentation/index.html=${documentation_page}"
    --file "documentation/fmi-ls-ref.html=${related_page}"
    --file model.png=docs/fmu/model.png
    --file documentation/licenses/license.txt=LICENSE)
if(WITH_SUNDIALS)
    list(APPEND documentation_arguments
        --file documentation/licenses/sundials-license.txt=docs/fmu/licenses/sundials-license.txt
        --file documentation/licenses/sundials-notice.txt=docs/fmu/licenses/sundials-notice.txt)
endif()
file(GLOB documentation_licenses CONFIGURE_DEPENDS docs/fmu/licenses/*.txt)
set(documentation_files
    "${documentation_page}" "${related_manifest}" "${related_page}" docs/fmu/model.png LICENSE ${documentation_licenses})
