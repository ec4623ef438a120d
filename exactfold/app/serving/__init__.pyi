from exactfold.app.serving.server import view_server as view_server
