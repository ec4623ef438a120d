"""What statics and kinematics say of the flat sheet."""
