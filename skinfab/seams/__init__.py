"""Where to cut: a set of seam edges, made by hand or found automatically."""
