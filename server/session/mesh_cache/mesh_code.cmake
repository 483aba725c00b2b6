# cmake -D OUT=FILE -D LIBRARIES=A,B -P mesh_code.cmake writes the definition of kMeshCode (mesh_code.h).
string(REPLACE "," ";" LIBRARIES "${LIBRARIES}")
set(hashes)
foreach(library ${LIBRARIES})
  file(SHA256 ${library} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 code "${hashes}")
file(WRITE ${OUT} "#include \"server/session/mesh_cache/mesh_code.h\"\n\nconst char phrenic::session::kMeshCode[] = \"${code}\";\n")
