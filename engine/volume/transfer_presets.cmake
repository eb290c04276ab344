# Sets transfer_presets to a source file with the presets of transfer functions, in the order in which they are listed.
set(TRANSFER_PRESETS "")
foreach(preset ct_bone ct_soft_tissue ct_skin ct_lung ct_vessels mr engine smoke fire viridis inferno magma plasma turbo grey cool_warm
               fog cloud hot skin_and_bone layers)
  get_filename_component(preset_file ${CMAKE_CURRENT_LIST_DIR}/../../apps/transfer_functions/${preset}.json ABSOLUTE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${preset_file})
  file(READ ${preset_file} preset_json)
  string(REPLACE "_" "-" preset_name ${preset})
  string(APPEND TRANSFER_PRESETS "    TransferPreset{\"${preset_name}\", R\"(${preset_json})\"},\n")
endforeach()
set(transfer_presets ${CMAKE_CURRENT_BINARY_DIR}/transfer_presets.cpp)
configure_file(${CMAKE_CURRENT_LIST_DIR}/transfer_presets.cpp.in ${transfer_presets} @ONLY)
