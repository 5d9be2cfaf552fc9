"""Many meshes times many settings: what to do, doing it on a cluster, once each, and the table of what came out."""
