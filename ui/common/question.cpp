#include "ui/common/question.h"

#include <QCoreApplication>
#include <QPushButton>

namespace trephine {

QMessageBox* ask(QWidget* parent, const char* name, const QString& loses, const QString& stays,
                 const QString& yes, std::function<void()> go_on) {
  auto* question = new QMessageBox(parent);
  question->setObjectName(name);
  question->setAttribute(Qt::WA_DeleteOnClose);
  question->setIcon(QMessageBox::Question);
  question->setWindowTitle(QCoreApplication::translate("Question", "Trephine"));
  question->setTextFormat(Qt::PlainText);
  question->setText(loses);
  question->setInformativeText(stays);
  QPushButton* going_on = question->addButton(yes, QMessageBox::DestructiveRole);
  going_on->setObjectName("goOnAnyway");
  question->setDefaultButton(question->addButton(QMessageBox::Cancel));
  // After the question has gone: what goes on may show a dialog of its own, or close the window.
  QObject::connect(question, &QMessageBox::buttonClicked, parent,
                   [=, go_on = std::move(go_on)](QAbstractButton* button) {
                     if (button == going_on) {
                       QMetaObject::invokeMethod(parent, go_on, Qt::QueuedConnection);
                     }
                   });
  question->open();
  return question;
}

void orElse(QMessageBox& question, const char* name, const QString& words,
            std::function<void()> then) {
  QPushButton* button = question.addButton(words, QMessageBox::AcceptRole);
  button->setObjectName(name);
  QObject::connect(button, &QPushButton::clicked, question.parent(), std::move(then),
                   Qt::QueuedConnection);
}

}  // namespace trephine
