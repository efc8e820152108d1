# Finds the font that engine/draw2d takes into the program, or says which package brings it.
set(NERITIC_FONT_FOLDER /usr/share/fonts/truetype/dejavu CACHE PATH "Where DejaVuSans.ttf and DejaVuSans-Bold.ttf lie")
set(NERITIC_FONT_REGULAR ${NERITIC_FONT_FOLDER}/DejaVuSans.ttf)
set(NERITIC_FONT_BOLD ${NERITIC_FONT_FOLDER}/DejaVuSans-Bold.ttf)
foreach(font ${NERITIC_FONT_REGULAR} ${NERITIC_FONT_BOLD})
  if(NOT EXISTS ${font})
    message(FATAL_ERROR "${font} is missing: install the Debian package fonts-dejavu-core (tools/setup does)")
  endif()
endforeach()
