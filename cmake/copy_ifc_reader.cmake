# -P script: the files that reading IFC takes, FROM the sources TO where the program looks for them. Without web-ifc: none.
set(web_ifc ${FROM}/node_modules/web-ifc)
if(NOT EXISTS ${web_ifc}/package.json)
  file(REMOVE_RECURSE ${TO})
  return()
endif()
file(GLOB scripts ${FROM}/*.mjs)
file(COPY ${scripts} DESTINATION ${TO})
file(COPY ${web_ifc}/package.json ${web_ifc}/LICENSE.md ${web_ifc}/web-ifc-api-node.js ${web_ifc}/web-ifc-node.wasm
  DESTINATION ${TO}/node_modules/web-ifc)
