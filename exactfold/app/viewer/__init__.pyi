from exactfold.app.viewer.document import view_document as view_document
from exactfold.app.viewer.page import view_page as view_page
from exactfold.app.viewer.page import write_view as write_view
