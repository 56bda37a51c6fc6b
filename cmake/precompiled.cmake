# What most files include is read once. Only for speed: a file still includes what it uses, and the preset dev, which
# reads all anew (CMAKE_DISABLE_PRECOMPILE_HEADERS), tells when it does not. Headers of our own stay out, because their
# names would meet those in the files' anonymous namespaces.
set(CLERESTORY_PRECOMPILED
  <algorithm> <array> <cmath> <filesystem> <functional> <map> <optional> <span> <string> <vector>)
