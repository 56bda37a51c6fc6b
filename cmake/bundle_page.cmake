# -P script: what pages are made with, FROM the sources TO where the program looks for it. The viewer is bundled with three.js
# where npm brought that and esbuild; else pages have no 3D view.
file(COPY ${FROM}/page.css DESTINATION ${TO})
set(three ${FROM}/node_modules/three)
file(GLOB esbuild ${FROM}/node_modules/@esbuild/*/bin/esbuild)
if(NOT esbuild OR NOT EXISTS ${three}/LICENSE)
  file(REMOVE ${TO}/viewer.js ${TO}/LICENSE.three.txt)
  message(STATUS "three.js or esbuild is missing (bash apps/install_dependencies.sh): pages will have no 3D view")
  return()
endif()
configure_file(${three}/LICENSE ${TO}/LICENSE.three.txt COPYONLY)
execute_process(COMMAND ${esbuild} ${FROM}/viewer.mjs --bundle --minify --format=iife --target=es2020 --legal-comments=inline
  --charset=ascii --log-level=warning --outfile=${TO}/viewer.js RESULT_VARIABLE failed)
if(failed)
  file(REMOVE ${TO}/viewer.js)
  message(FATAL_ERROR "esbuild could not bundle the viewer of pages: ${failed}")
endif()
