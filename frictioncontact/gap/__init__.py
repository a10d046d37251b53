"""The contact of rough surfaces: stiffness and area from their heights."""
